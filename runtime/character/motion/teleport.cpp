// teleport.cpp  see teleport.hpp.
#include "character/motion/teleport.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "character/motion/pose.hpp"
#include "character/motion/root_motion.hpp"
#include "math/rotation.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using RowMatrix3f = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
using RowMatrix34f = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

// What joint_teleports holds of a joint: in the last step; in the coming one, and in the last but not in the
// coming.
enum : uint32_t { kNone = 0, kTeleported = 1, kTeleports = 2, kGoesOn = 3 };

Vector3d place_of(const RootTransform& root) noexcept { return Eigen::Map<const Vector3d>(root.position_m); }
Quaterniond rotation_of(const RootTransform& root) noexcept { return quaternion(root.rotation_xyzw); }

// In the step after a teleport, by so much of a bound that goes on as before: at 60 frames a second 54
// heights/s^2.
constexpr double kAsBefore = 0.1;

// ---- the root ----

double dt_of(const Instance& instance) noexcept { return instance.plan.dt_s; }

// How far the coming step departs from the last one's velocity, the largest share of a bound.
double departure(const Vector3d& place_m, double angle_rad, double scale_log,
                 const TeleportBounds& most) noexcept {
  return std::max(
      {place_m.norm() / most.distance_m, angle_rad / most.angle_rad, std::abs(scale_log) / most.scale_log});
}

double root_departure(const Instance& instance, const TeleportBounds& most) noexcept {
  const InstanceState& state = *instance.state;
  const double dt_s = dt_of(instance);
  const Vector3d place =
      place_of(state.motion.root) + dt_s * Eigen::Map<const Vector3d>(state.motion.velocity_m_s);
  const Quaterniond turned = rotation_of(state.motion.root) *
                             exponential(dt_s * Eigen::Map<const Vector3d>(state.motion.angular_velocity));
  const double angle = logarithm(turned.conjugate() * rotation_of(state.motion.next_root)).norm();
  return departure(place_of(state.motion.next_root) - place, angle, 0, most);
}

// From which the last step's velocity leads to next_root in dt.
RootTransform root_leading_to_next(const Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const double dt_s = dt_of(instance);
  const Quaterniond rotation = rotation_of(state.motion.next_root) *
                               exponential(-dt_s * Eigen::Map<const Vector3d>(state.motion.angular_velocity));
  const Quaterniond turn = rotation * rotation_of(state.motion.root).conjugate();
  RootTransform root;
  root.scale = state.motion.next_root.scale;
  Eigen::Map<Vector3d>(root.position_m) =
      place_of(state.motion.next_root) -
      dt_s * (turn * Eigen::Map<const Vector3d>(state.motion.velocity_m_s));
  Eigen::Map<Eigen::Vector4f>(root.rotation_xyzw) = rotation.coeffs().cast<float>();
  return root;
}

// Of the coming step as it was given.
struct RawStep {
  Vector3d place_m, turn;
};
RawStep raw_step(const InstanceState& state) noexcept {
  return {place_of(state.motion.next_root) - place_of(state.motion.root),
          logarithm(rotation_of(state.motion.root).conjugate() * rotation_of(state.motion.next_root))};
}

// A step that goes just as fast as the one that teleported is no second teleport but a velocity that began at
// once.
bool goes_on_alike(const Instance& instance, const RawStep& step, const TeleportBounds& most) noexcept {
  const InstanceState& state = *instance.state;
  const double dt_s = dt_of(instance);
  const Vector3d place = step.place_m - dt_s * Eigen::Map<const Vector3d>(state.teleports.velocity_m_s);
  const Vector3d turn = step.turn - dt_s * Eigen::Map<const Vector3d>(state.teleports.spin);
  return departure(place, turn.norm(), 0, most) <= kAsBefore;
}

// told: it is one, whatever it looks like.
void carry_root(Instance& instance, bool told, const TeleportBounds& most) noexcept {
  InstanceState& state = *instance.state;
  const double off = root_departure(instance, most), dt_s = dt_of(instance);
  const bool jumps = told || off > 1;
  if (!jumps && !(dt_s > 0)) return;  // tells nothing of how it goes on
  const RawStep step = raw_step(state);
  const bool before = std::exchange(state.teleports.teleported, static_cast<uint16_t>(jumps)) != 0;
  if (jumps && (told || !(before && goes_on_alike(instance, step, most)))) {
    ++state.teleports.root_teleports;
    const double rate = dt_s > 0 ? 1 / dt_s : 0;
    Eigen::Map<Vector3d>(state.teleports.velocity_m_s) = rate * step.place_m;
    Eigen::Map<Vector3d>(state.teleports.spin) = rate * step.turn;
    if (before) {  // two cuts: of how it moves nothing is known
      std::fill_n(state.motion.velocity_m_s, 3, 0.0);
      std::fill_n(state.motion.angular_velocity, 3, 0.0);
    }
    move_past(instance, root_leading_to_next(instance));
    if (before) begin_line(instance);
  } else if (before && off > kAsBefore) {
    state.teleports.teleported = 0;
    begin_line(instance);
  }
}

// ---- joints ----

Vector3d place_of(const JointParts& parts) noexcept {
  return Eigen::Map<const Eigen::Vector3f>(parts.translation_m).cast<double>();
}

// What a joint did in the last step, and its parts then, now and as they are to be.
struct JointPath {
  JointParts before, now, next;
  Vector3d step_m, turn;  // as far as the coming step is long; turn along now's axes
};

JointPath path_of(const PoseHistory& motion, uint32_t joint, double ratio) noexcept {
  JointPath path{split_joint(motion.joints_before[joint]), split_joint(motion.joints[joint]),
                 split_joint(motion.next_joints[joint]), Vector3d::Zero(), Vector3d::Zero()};
  path.step_m = ratio * (place_of(path.now) - place_of(path.before));
  path.turn = ratio * logarithm(quaternion(path.before.rotation_xyzw).conjugate() *
                                quaternion(path.now.rotation_xyzw));
  return path;
}

double size_log(const JointParts& parts) noexcept {
  constexpr double kFlat = 1e-12;
  const double volume =
      std::abs(static_cast<double>(Eigen::Map<const RowMatrix3f>(parts.stretch).determinant()));
  return std::log(std::max(volume, kFlat)) / 3;
}

// Squares of what certainly does not teleport.
struct Sieve {
  float place, linear;  // m^2; of the matrix's own
};
Sieve sieve_of(const TeleportBounds& most) noexcept {
  // A matrix of size s that is turned by a differs by 2 sqrt(2) s sin(a / 2), sqrt(3) s being its norm; one
  // that has grown by a share of itself by sqrt(3) s times that.
  const double angle = std::min(most.angle_rad, 1.0), grown = std::min(most.scale_log, 0.5);
  const double least = std::min(2.8 / 1.7320508 * std::sin(angle / 2), 0.75 * grown);
  return {static_cast<float>(most.distance_m * most.distance_m), static_cast<float>(least * least)};
}

// Cheaply, by differences of matrices: the turn of a joint that spins counts as a departure, and an angle as
// its chord.
bool may_teleport(const PoseHistory& motion, uint32_t joint, float ratio, const Sieve& sieve) noexcept {
  using Columns = Eigen::Map<const Eigen::Array<float, 4, 3>>;  // a row of the matrix each
  const Columns before(&motion.joints_before[joint].m[0][0]), now(&motion.joints[joint].m[0][0]),
      next(&motion.next_joints[joint].m[0][0]);
  const Eigen::Array<float, 4, 3> change = next - now - ratio * (now - before);
  const Eigen::Array4f off = change.square().rowwise().sum(), own = now.square().rowwise().sum();
  return off[3] > sieve.place || off[0] + off[1] + off[2] > sieve.linear * (own[0] + own[1] + own[2]);
}

double joint_departure(const JointPath& path, const TeleportBounds& most) noexcept {
  const Quaterniond turned = quaternion(path.now.rotation_xyzw) * exponential(path.turn);
  return departure(place_of(path.next) - place_of(path.now) - path.step_m,
                   logarithm(turned.conjugate() * quaternion(path.next.rotation_xyzw)).norm(),
                   size_log(path.next) - size_log(path.now), most);
}

Matrix34 compose(const Quaterniond& rotation, const float (&stretch)[9], const Vector3d& place_m) noexcept {
  Matrix34 out;
  Eigen::Map<RowMatrix34f> m(&out.m[0][0]);
  m.leftCols<3>() =
      rotation.normalized().toRotationMatrix().cast<float>() * Eigen::Map<const RowMatrix3f>(stretch);
  m.col(3) = place_m.cast<float>();
  return out;
}

// Both past poses, so that they lead to the coming one as the last step went; as large as that.
void rebase_joint(PoseHistory& motion, uint32_t joint, const JointPath& path) noexcept {
  const Quaterniond was = quaternion(path.now.rotation_xyzw);
  const Quaterniond now = quaternion(path.next.rotation_xyzw) * exponential(-path.turn);
  const Quaterniond turn = now * was.conjugate();
  const Vector3d at_m = place_of(path.next) - turn * path.step_m;
  const Vector3d before_m = at_m - turn * (place_of(path.now) - place_of(path.before));
  motion.joints_before[joint] =
      compose(turn * quaternion(path.before.rotation_xyzw), path.next.stretch, before_m);
  motion.joints[joint] = compose(now, path.next.stretch, at_m);
}

// The one before, so that the coming step goes on from it; dt_before over dt is 1 / ratio.
void go_on(PoseHistory& motion, uint32_t joint, const JointPath& path, double ratio) noexcept {
  if (!(ratio > 0)) return;
  const Quaterniond now = quaternion(path.now.rotation_xyzw);
  const Vector3d turn = logarithm(now.conjugate() * quaternion(path.next.rotation_xyzw));
  motion.joints_before[joint] =
      compose(now * exponential(-turn / ratio), path.now.stretch,
              place_of(path.now) - (place_of(path.next) - place_of(path.now)) / ratio);
}

// Marks each that jumps, or that did in the last step; says whether there is one.
bool carry_joints(Instance& instance, const TeleportBounds& most, bool all) noexcept {
  const double dt_s = dt_of(instance), before_s = instance.state->motion.dt_before_s;
  const double ratio = before_s > 0 ? dt_s / before_s : 0;
  const Sieve sieve = sieve_of(most);
  uint32_t found = 0;
  for (uint32_t j = 0; j < instance.level->pack.character->joint_count; ++j) {
    uint32_t& mark = instance.motion.joint_teleports[j];
    if (mark == kNone && !all && !may_teleport(instance.motion, j, static_cast<float>(ratio), sieve))
      continue;
    const JointPath path = path_of(instance.motion, j, ratio);
    const double off = joint_departure(path, most);
    if (all || off > 1) {
      if (mark == kNone)
        rebase_joint(instance.motion, j, path);
      else  // two cuts: of how it moves nothing is known
        instance.motion.joints_before[j] = instance.motion.joints[j] = instance.motion.next_joints[j];
      mark = kTeleports;
    } else if (mark != kNone && dt_s > 0) {
      mark = off > kAsBefore ? kGoesOn : kNone;
      if (mark == kGoesOn) go_on(instance.motion, j, path, ratio);
    }
    found |= mark == kTeleports || mark == kGoesOn;
  }
  return found != 0;
}

bool follows(const pack::SkinRecord& skin, const uint32_t* marks) noexcept {
  for (uint32_t k = 0; k < pack::kInfluences; ++k)
    if (skin.weight[k] > 0 && marks[skin.joint[k]] != kNone) return true;
  return false;
}

bool rod_follows(const RodRig& rig, const RodSeat& seat, const uint32_t* marks) noexcept {
  for (uint32_t k = 0; k < seat.slot_count; ++k) {
    const RodSlot& slot = rig.slots()[seat.first_slot + k];
    if (marks[slot.joint] != kNone || (slot.bone != pack::kNoIndex && marks[slot.bone] != kNone)) return true;
  }
  return false;
}

void mark_parts(Instance& instance) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const uint32_t* marks = instance.motion.joint_teleports;
  uint32_t carried = 0;
  const bool followed = !instance.state->poses.motion_stale;  // else there is nothing that could be carried
  instance.state->teleports.carried_capsules |= followed;
  for (size_t r = 0; r < pack.regions.size(); ++r) {
    const auto nodes = pack.nodes.subspan(pack.regions[r].first_node, pack.regions[r].node_count);
    const bool one = std::ranges::any_of(nodes, [&](const auto& node) { return follows(node.skin, marks); });
    instance.motion.carried_regions[r] |= one && followed;
    carried += one;
  }
  const RodRig& rig = instance.asset->rods;
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) {
    const bool one = rod_follows(rig, rig.seats()[rod], marks);
    instance.motion.carried_rods[rod] |= one && followed;
    carried += one;
  }
  const bool teleported = std::ranges::any_of(std::span(marks, pack.character->joint_count),
                                              [](uint32_t m) { return m == kTeleports; });
  if (teleported) instance.state->teleports.part_teleports += carried;
  for (uint32_t j = 0; j < pack.character->joint_count; ++j)
    instance.motion.joint_teleports[j] = marks[j] == kTeleports ? kTeleported : kNone;
}

}  // namespace

TeleportBounds teleport_bounds(const TeleportDef& def, float height_m, double dt_s) noexcept {
  constexpr double kUsual_s = 1.0 / 60, kRounding = 1e-4;
  if (!(dt_s > 0)) return {kRounding * static_cast<double>(height_m), kRounding, kRounding};
  const double frames = std::max(1.0, dt_s / kUsual_s);
  return {frames * static_cast<double>(def.distance * height_m), frames * static_cast<double>(def.angle_rad),
          frames * std::log(static_cast<double>(def.scale))};
}

void carry_teleports(Instance& instance, const TeleportDef& def) noexcept {
  const TeleportBounds most = teleport_bounds(def, instance.level->pack.character->height_m, dt_of(instance));
  const bool all = std::exchange(instance.state->teleports.told, uint16_t{0}) != 0;
  const bool joints = carry_joints(instance, most, all), was = instance.state->teleports.teleported != 0;
  if (joints) mark_parts(instance);
  carry_root(instance, all, most);
  // The poses before the last two were not moved.
  if (joints || was || instance.state->teleports.teleported) instance.state->motion.dt_older_s = 0;
}

void carry_rods(Instance& instance) noexcept {
  if (instance.state->poses.motion_stale) return;  // what they swing with is not known
  std::fill_n(instance.motion.carried_rods, instance.asset->rods.rod_count, 1u);
}

void begin_line(Instance& instance) noexcept {
  carry_rods(instance);
  instance.state->motion.dt_before_s = 0;
  instance.state->poses.motion_stale = 1;
}

bool carries_parts(const Instance& instance) noexcept {
  const auto any = [](const uint32_t* marks, size_t count) {
    return std::any_of(marks, marks + count, [](uint32_t mark) { return mark != 0; });
  };
  return instance.state->teleports.carried_capsules != 0 ||
         any(instance.motion.carried_regions, instance.level->pack.regions.size()) ||
         any(instance.motion.carried_rods, instance.asset->rods.rod_count);
}

void forget_carried(Instance& instance) noexcept {
  instance.state->teleports.carried_capsules = 0;
  std::fill_n(instance.motion.carried_regions, instance.level->pack.regions.size(), 0u);
  std::fill_n(instance.motion.carried_rods, instance.asset->rods.rod_count, 0u);
}

void forget_teleports(Instance& instance) noexcept {
  forget_carried(instance);
  std::fill_n(instance.motion.joint_teleports, instance.level->pack.character->joint_count, 0u);
  instance.state->teleports.teleported = instance.state->teleports.told = 0;
}

}  // namespace sinew::world
