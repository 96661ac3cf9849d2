// rod_scene.cpp  Draws rods: material first, then segments end to end.
#include "baker/rods/rod_scene.hpp"

#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/truth/motion/random.hpp"

namespace sinew::baker {
namespace {

using rods::Turn;
using rods::Vector;

double log_uniform(Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform(0, 1));
}

Turn turn_by(const Vector3& axis, double angle_rad) {
  const double s = std::sin(angle_rad / 2);
  return {s * axis.x(), s * axis.y(), s * axis.z(), std::cos(angle_rad / 2)};
}

struct Material {
  double radius_m, density_kg_m3, young_pa, torsion_pa, drag_per_s, damping_s;
};

Material draw_material(const RodRange& range, double length_m, Random& random) {
  Material m;
  m.radius_m = length_m * log_uniform(random, 1e-3, 2e-2);
  m.density_kg_m3 = log_uniform(random, 200, 3000);
  m.young_pa = log_uniform(random, range.softest_pa, range.stiffest_pa);
  m.torsion_pa = log_uniform(random, range.softest_pa, range.stiffest_pa);
  m.drag_per_s = random.uniform(0, 1);
  m.damping_s = random.chance(0.5) ? 0 : log_uniform(random, 1e-3, 0.1);
  return m;
}

// Where a rod begins, and which way.
struct Beginning {
  Vector place;
  Turn turn;
  uint32_t parent;
};

Vector end_of(const rods::SegmentDef& s) {
  const Vector z = rods::turned(rods::turn_of(s.orientation), {0, 0, 1});
  Vector out;
  for (size_t k = 0; k < 3; ++k) out[k] = s.position_m[k] + 0.5 * static_cast<double>(s.length_m) * z[k];
  return out;
}

void append_rod(const Beginning& from, uint32_t count, double length_m, const Material& material,
                const Turn& by, std::vector<rods::SegmentDef>* out) {
  Vector end = from.place;
  Turn turn = from.turn;
  for (uint32_t i = 0; i < count; ++i) {
    rods::SegmentDef s;
    if (i > 0) turn = rods::normalised(rods::product(turn, by));
    const Vector z = rods::turned(turn, {0, 0, 1});
    s.length_m = static_cast<float>(length_m / count);
    for (size_t k = 0; k < 3; ++k) {
      s.position_m[k] = end[k] + 0.5 * static_cast<double>(s.length_m) * z[k];
      end[k] += static_cast<double>(s.length_m) * z[k];
    }
    for (size_t k = 0; k < 4; ++k) s.orientation[k] = static_cast<float>(turn[k]);
    s.radius_m = static_cast<float>(material.radius_m);
    s.density_kg_m3 = static_cast<float>(material.density_kg_m3);
    s.young_modulus_pa = static_cast<float>(material.young_pa);
    s.torsion_modulus_pa = static_cast<float>(material.torsion_pa);
    s.drag_per_s = static_cast<float>(material.drag_per_s);
    s.damping_s = static_cast<float>(material.damping_s);
    s.parent = i == 0 ? from.parent : static_cast<uint32_t>(out->size() - 1);
    out->push_back(s);
  }
}

uint32_t draw_count(const RodRange& range, Random& random) {
  return static_cast<uint32_t>(std::lround(random.uniform(range.least_segments, range.most_segments)));
}

// Rods that grow from any segment of those before them, half as long and thick as what they grow from.
void append_branches(const RodRange& range, double length_m, const Material& trunk, Random& random,
                     std::vector<rods::SegmentDef>* out) {
  for (int rod = 1; rod < range.rods; ++rod) {
    const auto parent = static_cast<uint32_t>(1 + random.below(out->size() - 1));
    const rods::SegmentDef from = (*out)[parent];
    Material material = trunk;
    material.radius_m = std::max(0.7 * static_cast<double>(from.radius_m), 0.1 * trunk.radius_m);
    const Turn bend = turn_by(random.direction(), random.uniform(0.3, 1.2));
    append_rod({end_of(from), rods::normalised(rods::product(rods::turn_of(from.orientation), bend)), parent},
               draw_count(range, random), length_m * random.uniform(0.2, 0.6), material,
               turn_by(random.direction(), random.uniform(0, 0.1)), out);
  }
}

}  // namespace

RodKind rod_kind(const std::string& name, const std::string& place) {
  if (name == "bending_rod") return RodKind::kBendingRod;
  if (name == "helix") return RodKind::kHelix;
  if (name == "tree") return RodKind::kTree;
  throw BadInput(place + ": scene '" + name + "' is none of bending_rod, helix, tree");
}

RootMotion::RootMotion(const rods::SegmentDef& root, double reach_m, uint64_t seed) {
  std::copy_n(root.position_m, 3, start_.position_m);
  std::copy_n(root.orientation, 4, start_.orientation);
  Random random(seed ^ 0x726f6f74);
  if (random.chance(0.5)) return;
  if (random.chance(1.0 / 3)) hold_s_ = 0.04;
  for (int k = 0; k < 3; ++k) {
    const Vector3 direction = random.direction(), axis = random.direction();
    waves_.push_back({{direction.x(), direction.y(), direction.z()},
                      {axis.x(), axis.y(), axis.z()},
                      reach_m * random.uniform(0, 0.3),
                      random.uniform(0, 0.25),
                      kTau * log_uniform(random, 0.2, 2),
                      random.uniform(0, kTau)});
  }
}

rods::SegmentPose RootMotion::at(double time_s) const {
  rods::SegmentPose out = start_;
  if (hold_s_ > 0) time_s = hold_s_ * std::floor(time_s / hold_s_ + 1e-6);
  const double ramp = std::min(1.0, time_s / 0.3), grown = ramp * ramp * (3 - 2 * ramp);
  Turn turn = rods::turn_of(start_.orientation);
  for (const Wave& w : waves_) {
    const double by = grown * (std::sin(w.rate * time_s + w.phase) - std::sin(w.phase));
    for (size_t k = 0; k < 3; ++k) out.position_m[k] += by * w.reach_m * w.direction[k];
    turn = rods::product(turn_by({w.axis[0], w.axis[1], w.axis[2]}, by * w.angle_rad), turn);
  }
  turn = rods::normalised(turn);
  for (size_t k = 0; k < 4; ++k) out.orientation[k] = static_cast<float>(turn[k]);
  return out;
}

RodScene make_rod_scene(const RodRange& range, uint64_t seed) {
  Random random(seed);
  const double length_m = log_uniform(random, 0.2, 4);
  const Material material = draw_material(range, length_m, random);
  const uint32_t count = draw_count(range, random);
  const Turn start = turn_by(random.direction(), random.uniform(0, kTau / 2));
  // A whole rod of a helix turns by up to four circles, that of a bending rod is straight at rest.
  const double turns = range.kind == RodKind::kBendingRod ? 0 : random.uniform(0.5, 4);
  const Turn by = turn_by(random.direction(), turns * kTau / count);
  RodScene scene;
  append_rod({{0, 0, 0}, start, rods::kNoParent}, count, length_m, material,
             range.kind == RodKind::kTree ? Turn{0, 0, 0, 1} : by, &scene.segments);
  if (range.kind == RodKind::kTree) append_branches(range, length_m, material, random, &scene.segments);
  scene.segments[0].fixed = true;
  scene.motion = RootMotion(scene.segments[0], length_m, seed);
  return scene;
}

}  // namespace sinew::baker
