// act.cpp  see act.hpp.
#include "tests/extremes/act.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace sinew::extremes {
namespace {

void require(const Status& status, const std::string& what) {
  if (!status.ok()) throw std::runtime_error(what + ": " + status.message);
}

bool all_finite(std::span<const float> values) {
  return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

std::vector<float> displacements(const Act& act) {
  std::vector<float> out(size_t{3} * act.subject.info.moved_vertex_count);
  if (out.empty()) return out;
  require(act.world.read_surface(act.instance, {.space = Space::kBind,
                                                .moved_only = true,
                                                .capacity = act.subject.info.moved_vertex_count,
                                                .positions = {.out = out.data()}}),
          "read_surface");
  return out;
}

std::vector<Matrix34> shown_joints(const Act& act) {
  std::vector<Matrix34> out(act.subject.info.joint_count);
  require(act.world.read_joint_matrices(act.instance, out), "read_joint_matrices");
  return out;
}

}  // namespace

double Draws::between(double from, double to) {
  return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53;
}
double Draws::of_any_size(double least, double most) {
  return std::exp(between(std::log(least), std::log(most)));
}
uint32_t Draws::below(uint32_t count) { return static_cast<uint32_t>(random_() % count); }
void Draws::direction(double (&out)[3]) {
  const double up = between(-1, 1), angle = between(0, 2 * std::numbers::pi), flat = std::sqrt(1 - up * up);
  out[0] = flat * std::cos(angle), out[1] = up, out[2] = flat * std::sin(angle);
}

uint32_t AnyHits::find(std::span<const ContactProbe> probes, float, std::span<ContactHit> hits) noexcept {
  Draws draws(seed++);
  uint32_t count = 0;
  for (uint32_t p = 0; p < probes.size() && count < hits.size(); ++p) {
    if (!draws.chance(share)) continue;
    ContactHit hit{.probe = p, .along = draws.chance(0.5) ? 1.0f : -1.0f};
    hit.gap_m = draws.between(-depth_m, 0.2 * depth_m);
    double normal[3], velocity[3];
    draws.direction(normal);
    draws.direction(velocity);
    for (int k = 0; k < 3; ++k) hit.normal[k] = static_cast<float>(normal[k]);
    for (int k = 0; k < 3; ++k) hit.velocity_m_s[k] = static_cast<float>(speed_m_s * velocity[k]);
    hit.name = draws.below(4);
    if (draws.chance(bad_share)) {
      const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                           -5e37f, 3};
      float* const numbers[] = {&hit.along, &hit.normal[0], &hit.velocity_m_s[1], &hit.friction,
                                &hit.restitution};
      *numbers[draws.below(5)] = bad[draws.below(4)];
    }
    hits[count++] = hit;
  }
  return count;
}

Subject::Subject(std::string of, std::span<const std::byte> pack) : name(std::move(of)) {
  make_worlds();
  for (int w = 0; w < 3; ++w) require(worlds[w].load_asset(pack, &assets[w]), name);
  look();
}

Subject::Subject(const std::string& path) : name(path.substr(path.find_last_of('/') + 1)) {
  make_worlds();
  for (int w = 0; w < 3; ++w)
    if (const Status status = worlds[w].load_asset_file(path.c_str(), &assets[w]); !status.ok())
      throw std::runtime_error(status.message);  // which names the path
  look();
}

void Subject::make_worlds() {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  for (int w = 0; w < 3; ++w) {
    WorldDef def{.max_assets = 1, .max_instances = 1, .budget_mode = BudgetMode::kWorkUnits};
    if (w == 1) def.teleport = {kNever, kNever, kNever, kNever};
    require(World::create(def, &worlds[w]), name);
  }
}

void Subject::look() {
  World& world = worlds[0];
  require(world.asset_info(assets[0], &info), name);
  AssetArrays arrays;
  require(world.asset_arrays(assets[0], &arrays), name);
  for (size_t k = 0; k < 3; ++k) {
    float least = HUGE_VALF, most = -HUGE_VALF;
    for (size_t at = k; at < arrays.positions_m.size(); at += 3)
      least = std::min(least, arrays.positions_m[at]), most = std::max(most, arrays.positions_m[at]);
    extent_m = std::max(extent_m, most - least);
  }
  bind.resize(info.joint_count);
  require(world.bind_pose(assets[0], bind), name);
  regions.resize(info.region_count);
  for (uint32_t r = 0; r < info.region_count; ++r)
    require(world.region_info(assets[0], r, &regions[r]), name);
  rods.resize(info.rod_count);
  for (uint32_t r = 0; r < info.rod_count; ++r) require(world.rod_info(assets[0], r, &rods[r]), name);
  for (uint32_t j = 0; j < info.joint_count; ++j) {
    JointInfo joint;
    require(world.joint_info(assets[0], j, &joint), name);
    parents.push_back(joint.parent);
  }
}

Act::Act(Subject& of, uint32_t world_index, uint64_t seed)
    : subject(of), world(of.worlds[world_index]), asset(of.assets[world_index]), draws(seed) {
  if (of.info.clip_count > 0) clip = draws.below(of.info.clip_count);
  joints = of.bind;
  hits.seed = seed;
}

Act::~Act() {
  undo();
  (void)world.destroy_instance(instance);
}

void Act::undo() {
  (void)world.set_budget_us(std::numeric_limits<float>::infinity());
  (void)world.set_environment({});
  (void)world.set_added_environment(instance, {});
  (void)world.set_parameters(instance, {});
  for (uint32_t r = 0; r < subject.info.region_count; ++r) (void)world.set_region_parameters(instance, r, {});
  for (uint32_t r = 0; r < subject.info.rod_count; ++r) (void)world.set_rod_parameters(instance, r, {});
  (void)world.set_hidden(instance, false);
  (void)world.set_tier_limit(instance, Tier::kNetwork);
  (void)world.set_time_scale(instance, 1);
  (void)world.set_felt_root_motion(instance, 1);
  walls.walls.clear();
  hits.share = 0;
}

void Act::begin_frame() {
  joints = subject.bind;
  if (clip != kNone)
    require(world.sample_clip(subject.assets[0], clip, time_s, ClipEnd::kLoop, joints), "sample_clip");
  root = {};
  dt_s = 1.0 / 60;
  teleport = false;
  poses = true;
}

FrameReport Act::step() {
  if (poses) (void)world.set_pose(instance, {.joints = joints, .root = root, .teleport = teleport});
  const FrameReport report = world.step(static_cast<float>(dt_s));
  time_s += dt_s > 0 ? std::min(dt_s, 0.1) : 0;
  ++frame;
  return report;
}

void Act::move_joint(uint32_t joint, const double (&matrix)[3][3], const double (&by_m)[3]) {
  const Matrix34 about = joints[joint];
  for (uint32_t j = joint; j < joints.size(); ++j) {
    uint32_t above = j;
    while (above != joint && above != kNone && above > joint) above = subject.parents[above];
    if (above != joint) continue;
    const Matrix34 before = joints[j];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) {
        double sum = 0;
        for (int k = 0; k < 3; ++k)
          sum += matrix[r][k] * (double{before.m[k][c]} - (c == 3 ? double{about.m[k][3]} : 0));
        joints[j].m[r][c] = static_cast<float>(sum + (c == 3 ? double{about.m[r][3]} + by_m[r] : 0));
      }
    }
  }
}

Reading read(const Act& act, bool normals) {
  Reading out;
  const std::vector<float> moved = displacements(act);
  const std::vector<Matrix34> joints = shown_joints(act);
  for (size_t i = 0; i + 2 < moved.size(); i += 3)
    out.displacement = std::max(out.displacement, std::hypot(moved[i], moved[i + 1], moved[i + 2]));
  out.displacement /= act.subject.extent_m;
  out.finite = all_finite(moved) && all_finite({&joints[0].m[0][0], 12 * joints.size()});
  if (!normals) return out;
  const uint32_t vertices = act.subject.info.vertex_count;
  std::vector<float> places(size_t{3} * vertices), directions(size_t{3} * vertices);
  Bounds ball;
  require(act.world.bounds(act.instance, &ball), "bounds");
  SurfaceReadDef def{.space = Space::kWorld,
                     .capacity = vertices,
                     .positions = {.out = places.data()},
                     .normals = {.out = directions.data()}};
  std::ranges::copy(ball.center_m, def.origin_m);
  require(act.world.read_surface(act.instance, def), "read_surface");
  for (size_t i = 0; i + 2 < places.size(); i += 3)
    out.outside =
        std::max(out.outside, std::hypot(places[i], places[i + 1], places[i + 2]) / ball.radius_m - 1);
  out.finite = out.finite && all_finite(places) && all_finite(directions);
  return out;
}

std::vector<float> shown(const Act& act) {
  std::vector<float> out = displacements(act);
  if (act.subject.info.rod_count == 0) return out;
  for (const Matrix34& joint : shown_joints(act))
    for (const int k : {0, 1, 2}) out.push_back(joint.m[k][3]);
  return out;
}

}  // namespace sinew::extremes
