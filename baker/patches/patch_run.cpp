// patch_run.cpp  Drives a body by a random motion and writes down what its nodes do.
#include "baker/patches/patch_run.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "baker/patches/rigid_motion.hpp"
#include "baker/truth/fem/fem.hpp"

namespace sinew::baker {
namespace {

using Eigen::VectorXd;

constexpr double kTolerance = 1e-6;
constexpr int kExplicitSubsteps[] = {1, 50, 100};

struct Body {
  VoxelBody shape;
  std::vector<double> young;  // a tetrahedron
  Fem fem;
  double first_rad;  // of its first mode, a tick
};

// Stiffness along a random direction changes by up to a factor of five either way.
std::vector<double> paint(const VoxelBody& shape, double stiffness, bool is_painted, Random& random) {
  const Vector3 along = random.direction();
  const double tilt = is_painted ? random.uniform(0.3, 1) * std::log(5.0) : 0, wave = random.uniform(0.5, 2);
  std::vector<double> young;
  for (size_t e = 0; e < shape.tetrahedra.size(); ++e) {
    Vector3 middle = Vector3::Zero();
    for (const int n : shape.tetrahedra[e]) middle += 0.25 * shape.nodes[static_cast<size_t>(n)];
    const double share = std::sin(wave * along.dot(middle) / shape.depth);
    young.push_back(stiffness * shape.fill[e] * std::exp(tilt * share));
  }
  return young;
}

FemMaterial material_of(const VoxelBody& shape, const std::vector<double>& young) {
  FemMaterial material;
  material.young_pa = young;
  material.density_kg_m3 = 1;
  material.fill = shape.fill;
  return material;
}

double stiffness_of(const PatchLine& line, uint64_t run, Random& random) {
  const double share = line.stiffnesses == 0 ? random.uniform(0, 1)
                       : line.stiffnesses == 1
                           ? 0
                           : 1.0 * static_cast<double>(run % line.stiffnesses) / (line.stiffnesses - 1);
  return line.least_stiffness * std::pow(line.most_stiffness / line.least_stiffness, share);
}

Body draw_body(const PatchLine& line, const PatchPlan& plan, uint64_t run, Random& random) {
  VoxelBody shape = make_body(line.kind, random.uniform(line.least_size, line.most_size), random);
  std::vector<double> young = paint(shape, stiffness_of(line, run, random), line.is_painted, random);
  Fem fem(shape.nodes, shape.tetrahedra, shape.constrained, material_of(shape, young));
  const double first = kTau * fem.frequencies_hz(1).front();
  if (plan.damping_ratio > 0) fem.damp(plan.damping_ratio);
  fem.backward_euler = plan.backward_euler;
  return {std::move(shape), std::move(young), std::move(fem), first};
}

// So lively that flesh moves by two to sixty hundredths of its depth, or as much as the plan lets it.
Liveliness draw_liveliness(const Body& body, double most_acceleration, Random& random) {
  constexpr double kMostRad = 1.2;
  const double share = 0.02 * std::pow(30, random.uniform(0, 1));
  const double slow = std::min(body.first_rad, kMostRad);
  return {
      .acceleration = std::min(most_acceleration, share * body.shape.depth * body.first_rad * body.first_rad),
      .reach = body.shape.depth,
      .least_rad = 0.12 * slow,
      .most_rad = std::min(1.6 * slow, kMostRad)};
}

VectorXd placed(const VoxelBody& shape, const RigidPose& pose) {
  VectorXd out(3 * static_cast<Eigen::Index>(shape.nodes.size()));
  for (size_t i = 0; i < shape.nodes.size(); ++i)
    out.segment<3>(3 * static_cast<Eigen::Index>(i)) = pose.turn * shape.nodes[i] + pose.place;
  return out;
}

void advance(Fem& fem, const VoxelBody& shape, const RigidPose& from, const RigidPose& to, double dt,
             bool damped) {
  UndisturbedMotion held{placed(shape, from), placed(shape, to), {}};
  held.turn.assign(shape.nodes.size(), to.turn * from.turn.transpose());
  const VectorXd none = VectorXd::Zero(held.after.size());
  fem.step(dt, held.after, none, kTolerance, damped ? &held : nullptr);
}

// ---- explicit central differences ----

// From positions of two ticks to those of the next; constrained nodes go straight. What two ticks tell is the
// velocity between them, half a tick ago: the first substep's is later.
VectorXd explicit_tick(const Body& body, const VectorXd& before, const VectorXd& now, const VectorXd& target,
                       int substeps) {
  const double dt = 1.0 / substeps;
  VectorXd x = now, v = now - before;
  for (int s = 0; s < substeps; ++s) {
    const VectorXd force = body.fem.elastic_force(x);
    const double kicks = s > 0 ? dt : dt + 0.5 * (1 - dt);
    for (size_t i = 0; i < body.shape.nodes.size(); ++i) {
      const auto at = 3 * static_cast<Eigen::Index>(i);
      if (body.shape.constrained[i]) {
        x.segment<3>(at) = now.segment<3>(at) + (s + 1) * dt * (target - now).segment<3>(at);
        continue;
      }
      v.segment<3>(at) += kicks / body.fem.mass[static_cast<Eigen::Index>(i)] * force.segment<3>(at);
      x.segment<3>(at) += dt * v.segment<3>(at);
    }
  }
  return x;
}

double miss(const Body& body, const VectorXd& a, const VectorXd& b) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < body.shape.nodes.size(); ++i)
    if (!body.shape.constrained[i]) {
      const auto at = 3 * static_cast<Eigen::Index>(i);
      sum += (a - b).segment<3>(at).squaredNorm();
      ++count;
    }
  return std::sqrt(sum / count);
}

void add_explicit(const Body& body, const std::vector<VectorXd>& truth, Safetensors* out) {
  constexpr double kExploded = 1e6;
  for (const int substeps : kExplicitSubsteps) {
    std::vector<float> single = {0}, rolled = {0};
    VectorXd before = truth[0], now = truth[1];
    bool exploded = false;
    for (size_t t = 2; t < truth.size(); ++t) {
      single.push_back(static_cast<float>(std::min(
          kExploded,
          miss(body, explicit_tick(body, truth[t - 2], truth[t - 1], truth[t], substeps), truth[t]))));
      if (!exploded) {
        const VectorXd next = explicit_tick(body, before, now, truth[t], substeps);
        before = std::exchange(now, next);
        exploded = !(miss(body, now, truth[t]) < kExploded);
      }
      rolled.push_back(static_cast<float>(exploded ? kExploded : miss(body, now, truth[t])));
    }
    const std::string name = "explicit." + std::to_string(substeps);
    out->tensors[name + ".single"] = tensor_f32({single.size()}, single);
    out->tensors[name + ".rolled"] = tensor_f32({rolled.size()}, rolled);
  }
}

// ---- what is written ----

template <class Derived>
void append(const Eigen::MatrixBase<Derived>& v, std::vector<float>* out) {
  for (Eigen::Index row = 0; row < v.rows(); ++row)
    for (Eigen::Index column = 0; column < v.cols(); ++column)
      out->push_back(static_cast<float>(v(row, column)));
}

void append_displacement(const VoxelBody& shape, const RigidPose& pose, const VectorXd& at,
                         std::vector<float>* out) {
  for (size_t i = 0; i < shape.nodes.size(); ++i)
    append(pose.turn.transpose() * (at.segment<3>(3 * static_cast<Eigen::Index>(i)) - pose.place) -
               shape.nodes[i],
           out);
}

void add_body(const Body& body, Safetensors* out) {
  const VoxelBody& shape = body.shape;
  std::vector<float> rest, material;
  std::vector<int32_t> edges, constrained(shape.constrained.begin(), shape.constrained.end());
  std::vector<double> k(shape.nodes.size());
  for (size_t e = 0; e < shape.tetrahedra.size(); ++e) {
    const auto corner = [&](size_t c) { return shape.nodes[static_cast<size_t>(shape.tetrahedra[e][c])]; };
    const double volume = (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0)) / 6;
    for (const int n : shape.tetrahedra[e]) k[static_cast<size_t>(n)] += 0.25 * volume * body.young[e];
  }
  for (size_t i = 0; i < shape.nodes.size(); ++i) {
    const double m = body.fem.mass[static_cast<Eigen::Index>(i)];
    append(shape.nodes[i], &rest);
    append(Vector3(std::log(k[i]), m, std::log(k[i] / m)), &material);
  }
  for (const auto& [a, b] : edges_of(shape.tetrahedra)) edges.insert(edges.end(), {a, b});
  const size_t n = shape.nodes.size();
  out->tensors["rest"] = tensor_f32({n, 3}, rest);
  out->tensors["material"] = tensor_f32({n, 3}, material);
  out->tensors["edges"] = tensor_i32({edges.size() / 2, 2}, edges);
  out->tensors["constrained"] = tensor_i32({n}, constrained);
}

}  // namespace

Safetensors simulate_patches(const PatchLine& line, const PatchPlan& plan, uint64_t seed,
                             bool with_explicit) {
  Random random(seed + 0x100000000u * static_cast<uint64_t>(line.kind));
  Body body = draw_body(line, plan, seed - line.first_seed, random);
  const std::vector<RigidPose> motion = random_rigid_motion(
      draw_liveliness(body, line.most_acceleration, random), line.ticks, plan.substeps, random);
  body.fem.reset(placed(body.shape, motion[0]));
  std::vector<float> place, turn, displacement;
  std::vector<VectorXd> truth;
  const auto keep = [&](const RigidPose& pose) {
    append(pose.place, &place);
    append(pose.turn, &turn);
    append_displacement(body.shape, pose, body.fem.positions, &displacement);
    if (with_explicit) truth.push_back(body.fem.positions);
  };
  keep(motion[0]);
  const bool damped = plan.damping_ratio > 0;
  for (size_t s = 1; s < motion.size(); ++s) {
    advance(body.fem, body.shape, motion[s - 1], motion[s], 1.0 / plan.substeps, damped);
    if (s % plan.substeps == 0) keep(motion[s]);
  }
  Safetensors out;
  const size_t ticks = line.ticks + size_t{1}, n = body.shape.nodes.size();
  out.tensors["place"] = tensor_f32({ticks, 3}, place);
  out.tensors["turn"] = tensor_f32({ticks, 9}, turn);
  out.tensors["displacement"] = tensor_f32({ticks, n, 3}, displacement);
  add_body(body, &out);
  if (with_explicit) add_explicit(body, truth, &out);
  out.metadata = {{"sinew.patches", "1"},
                  {"shape", line.shape},
                  {"split", line.split},
                  {"seed", std::to_string(seed)},
                  {"first", std::to_string(body.first_rad)},
                  {"rate_hz", std::to_string(plan.rate_hz)},
                  {"substeps", std::to_string(plan.substeps)},
                  {"integrator", plan.backward_euler ? "backward_euler" : "bdf2"},
                  {"damping_ratio", std::to_string(plan.damping_ratio)}};
  return out;
}

}  // namespace sinew::baker
