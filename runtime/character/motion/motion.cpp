// motion.cpp  Poses at ticks, the history that accelerations are taken from.
#include "character/motion/motion.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "character/motion/root_motion.hpp"
#include "character/motion/teleport.hpp"
#include "character/rest/asleep.hpp"
#include "character/rods/own_body.hpp"
#include "character/rods/rod_motion.hpp"
#include "math/rotation.hpp"
#include "tissue/frames/node_bend.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Below it, a difference of two poses over dt says more about rounding than about motion.
constexpr double kShortestStep_s = 1e-4;
// A step is extended backwards by at most so many times its own length when the history is rebuilt.
constexpr double kFarthestBack = 16;

Vector3d place_of(const RootTransform& root) noexcept { return Eigen::Map<const Vector3d>(root.position_m); }

Quaterniond rotation_of(const RootTransform& root) noexcept { return quaternion(root.rotation_xyzw); }

// The root's two steps before this one, along their courses.
void remember_root_steps(Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  for (int k = 0; k < 3; ++k) {
    instance.motion.root_step.place_m[k] = state.motion.velocity_m_s[k] * state.motion.dt_before_s;
    instance.motion.root_step.turn[k] = state.motion.angular_velocity[k] * state.motion.dt_before_s;
    instance.motion.root_step_before.place_m[k] =
        state.motion.velocity_before_m_s[k] * state.motion.dt_older_s;
    instance.motion.root_step_before.turn[k] =
        state.motion.angular_velocity_before[k] * state.motion.dt_older_s;
  }
}

void measure_velocity(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const double dt_s = instance.plan.dt_s;
  if (dt_s < kShortestStep_s) return;
  const Vector3d turn =
      logarithm(rotation_of(state.motion.root).conjugate() * rotation_of(state.motion.next_root));
  std::copy_n(state.motion.velocity_m_s, 3, state.motion.velocity_before_m_s);
  std::copy_n(state.motion.angular_velocity, 3, state.motion.angular_velocity_before);
  Eigen::Map<Vector3d>(state.motion.velocity_m_s) =
      (place_of(state.motion.next_root) - place_of(state.motion.root)) / dt_s;
  Eigen::Map<Vector3d>(state.motion.angular_velocity) = turn / dt_s;
}

void copy_joints(const Instance& instance, const Matrix34* from, Matrix34* to) noexcept {
  std::copy_n(from, instance.level->pack.character->joint_count, to);
}

void split_poses(Instance& instance) noexcept {
  if (std::exchange(instance.motion.parts_ready, true)) return;
  for (uint32_t j = 0; j < instance.level->pack.character->joint_count; ++j) {
    instance.motion.parts_older[j] = split_joint(instance.motion.joints_older[j]);
    instance.motion.parts_before[j] = split_joint(instance.motion.joints_before[j]);
    instance.motion.parts[j] = split_joint(instance.motion.joints[j]);
    instance.motion.next_parts[j] = split_joint(instance.motion.next_joints[j]);
  }
}

// Share of the way from the present pose to the next; the end of the step is met exactly.
double share_at(const Instance& instance, double time_s) noexcept {
  constexpr double kSame = 1e-5;
  const double share = instance.plan.dt_s > 0 ? time_s / instance.plan.dt_s : 1;
  return std::abs(share - 1) < kSame ? 1 : share;
}

PathWeights weights_at(const Instance& instance, double share) noexcept {
  const InstanceState& state = *instance.state;
  return path_weights(share, instance.plan.dt_s, state.motion.dt_before_s, state.motion.dt_older_s);
}

const Matrix34* joints_at(Instance& instance, double share) noexcept {
  if (share == 1) return instance.motion.next_joints;
  split_poses(instance);
  const PathWeights weights = weights_at(instance, share);
  for (uint32_t j = 0; j < instance.level->pack.character->joint_count; ++j) {
    instance.motion.tick_joints[j] =
        joint_between(instance.motion.parts_older[j], instance.motion.parts_before[j],
                      instance.motion.parts[j], instance.motion.next_parts[j], weights);
  }
  return instance.motion.tick_joints;
}

RootTransform root_at(const Instance& instance, double share) noexcept {
  const InstanceState& state = *instance.state;
  if (share == 1) return state.motion.next_root;
  return root_between(instance.motion.root_step_before, instance.motion.root_step, state.motion.root,
                      state.motion.next_root, weights_at(instance, share));
}

void pose_nodes(Instance& instance, const Matrix34* joints, const RootTransform& root,
                tissue::NodePose* out) noexcept {
  const pack::PackView& pack = instance.level->pack;
  skin_matrices(pack.joints, joints, instance.motion.skin);
  tissue::pose_nodes(pack.nodes, instance.motion.skin, root.rotation_xyzw, out);
  for (const pack::RegionRecord& region : pack.regions)
    if (region.node_count > 0)
      tissue::share_bend(region.anchor_node, region.node_count, out + region.first_node);
}

void remember_skin(Instance& instance, const RootTransform& root) noexcept {
  if (!instance.contacts.pushes) return;
  const size_t floats = size_t{12} * instance.level->pack.character->joint_count;
  std::copy_n(instance.contacts.tick_skin[0], floats, instance.contacts.tick_skin[1]);
  std::copy_n(instance.contacts.tick_turn[0], 4, instance.contacts.tick_turn[1]);
  std::copy_n(instance.motion.skin, floats, instance.contacts.tick_skin[0]);
  std::copy_n(root.rotation_xyzw, 4, instance.contacts.tick_turn[0]);
}

// Shifts the history by one tick and puts the pose at `share` in front.
void push_pose(Instance& instance, double share) noexcept {
  auto& roots = instance.state->motion.tick_root_m;
  const size_t bytes = sizeof(tissue::NodePose) * instance.level->node_count();
  for (int back = 2; back > 0; --back) {
    std::memcpy(instance.motion.poses[back], instance.motion.poses[back - 1], bytes);
    std::copy_n(roots[back - 1], 3, roots[back]);
  }
  const RootTransform root = root_at(instance, share);
  const Matrix34* joints = joints_at(instance, share);
  pose_nodes(instance, joints, root, instance.motion.poses[0]);
  rest_rods(instance, joints, root);
  pose_proxies(instance, joints, root);
  std::copy_n(root.position_m, 3, roots[0]);
  remember_skin(instance, root);
}

// Of the last two ticks, of nodes that were not followed: as after ticks that were not followed.
void pose_past_nodes(Instance& instance, double share, double back) noexcept {
  for (int tick = 2; tick > 0; --tick)
    pose_nodes(instance, joints_at(instance, share - tick * back), root_at(instance, share - tick * back),
               instance.motion.poses[tick - 1]);
}

// The same of the parts that are carried over a teleport (character/motion/teleport.hpp), and of what may
// touch them.
void pose_past_parts(Instance& instance, double share, double back) noexcept {
  const pack::PackView& pack = instance.level->pack;
  for (int tick = 2; tick > 0; --tick) {
    const RootTransform root = root_at(instance, share - tick * back);
    const Matrix34* joints = joints_at(instance, share - tick * back);
    tissue::NodePose *all = instance.motion.poses[2],
                     *kept = instance.motion.poses[tick - 1];  // the oldest goes next
    pose_nodes(instance, joints, root, all);
    for (size_t r = 0; r < pack.regions.size(); ++r) {
      const pack::RegionRecord& region = pack.regions[r];
      if (instance.motion.carried_regions[r])
        std::copy_n(all + region.first_node, region.node_count, kept + region.first_node);
    }
    rest_carried_rods(instance, joints, root, tick - 1);
    if (tick == 1) {
      wake_rods(instance);  // so that capsules' last tick is kept
      pose_proxies(instance, joints, root);
      if (instance.contacts.pushes)
        std::copy_n(instance.motion.skin, size_t{12} * pack.character->joint_count,
                    instance.contacts.tick_skin[0]);
    }
  }
}

}  // namespace

void take_pose(Instance& instance, const TeleportDef& teleport) noexcept {
  InstanceState& state = *instance.state;
  instance.motion.parts_ready = false;
  if (!state.poses.has_next) {
    copy_joints(instance, instance.motion.joints, instance.motion.next_joints);
    state.motion.next_root = state.motion.root;
  } else if (state.poses.at_start) {
    state.teleports.told = 0;
    copy_joints(instance, instance.motion.next_joints, instance.motion.joints);
    state.motion.dt_before_s = 0;
    state.motion.root = state.motion.next_root;
    state.poses.at_start = 0;
    state.motion.space_id = state.motion.next_space_id;  // it has always been there
    state.tissue.untouched = 1;
    state.poses.motion_stale = 1;
  } else {
    leave_out_unfelt(instance);
    carry_teleports(instance, teleport);
  }
  keep_space(instance);
  for (const auto& source : instance.contacts.scaled)
    if (source) source->set_scale(state.motion.next_root.scale);
  remember_root_steps(instance);
  measure_velocity(instance);
}

void keep_pose(Instance& instance) noexcept {
  instance.state->poses.first_joints = (instance.state->poses.first_joints + 1) % 4;
  point_to_state(instance);
  // A pose that only counts as held says nothing of how the next is reached.
  instance.state->motion.dt_older_s = instance.state->motion.dt_before_s;
  instance.state->motion.dt_before_s = instance.marks.came_back ? 0 : instance.plan.dt_s;
  instance.state->motion.root = instance.state->motion.next_root;
  instance.state->poses.has_next = 0;
  instance.state->poses.skips_pose = 0;
  instance.state->poses.without_pose_s = 0;
}

void follow_motion(Instance& instance, double time_s) noexcept {
  const double share = share_at(instance, time_s);
  const double tick = instance.plan.dt_s > 0 ? instance.asset->tick_s / instance.plan.dt_s : 0;
  const double back = tick <= kFarthestBack ? tick : 0;
  const bool raised = std::exchange(instance.marks.level_raised, false), carries = carries_parts(instance);
  if (carries) remember_rod_velocities(instance);
  if (std::exchange(instance.state->poses.motion_stale, 0u)) {
    begin_rods(instance);
    push_pose(instance, share - 2 * back);
    push_pose(instance, share - back);
  } else {
    if (raised) pose_past_nodes(instance, share, back);
    if (carries) pose_past_parts(instance, share, back);
  }
  push_pose(instance, share);
}

void pose_now(Instance& instance, tissue::NodePose* out) noexcept {
  pose_nodes(instance, instance.motion.joints, instance.state->motion.root, out);
}

}  // namespace sinew::world
