// pose_history.hpp  Where an instance's root and joints were: what poses, and what ticks between them, tell
// of its motion.
#pragma once
#include <cstdint>

#include "character/asset/asset.hpp"
#include "character/motion/pose.hpp"
#include "core/arena.hpp"
#include "sinew/types.hpp"
#include "tissue/frames/node_pose.hpp"

namespace sinew::world {

// ---- plain bytes, saved and restored as they are ----

// Of the root, by steps and by ticks.
struct RootMotion {
  RootTransform root, next_root;    // at the end of the last step; of the pose set since
  RootTransform space, next_space;  // likewise, of Pose::space; character/motion/root_motion.hpp
  double dt_older_s = 0;            // of the step before the last
  double dt_before_s = 0;           // of the last step; 0: none, or none to compare with
  double velocity_m_s[3] = {};      // of the root over the last step, world
  double angular_velocity[3] = {};  // rad/s, character axes
  double velocity_before_m_s[3] = {}, angular_velocity_before[3] = {};  // likewise, of the step before that
  double ride_velocity_m_s[3] = {};                                     // of what it rides on, where it is
  double tick_root_m[3][3] = {};  // of the last three ticks, newest first
  uint32_t space_id = 0, next_space_id = 0;
  uint32_t space_changed = 0;  // in the last step
  float felt_root = 1;         // World::set_felt_root_motion
};

// Which poses there are, and how far beyond the last tick the last one is.
struct PoseClock {
  float render_fraction = 0;  // remainder in ticks: how far beyond the last tick is shown
  uint32_t has_next = 0;      // set_pose since the last step
  uint32_t at_start = 1;      // no pose yet: the first one is taken as having been held for ever
  uint32_t motion_stale = 1;  // ticks were not followed: the motion history is rebuilt before use
  uint32_t first_joints = 0;  // which of pose_joints is the oldest pose
  uint32_t still_ticks = 0;   // character/rest/dormant.hpp
  float time_scale = 1;       // World::set_time_scale
  uint32_t skips_pose = 0;    // none is due in the coming step (world/step/skip_pose.hpp)
  double without_pose_s = 0;  // of its own time, since the last one was due
};

// character/motion/teleport.hpp
struct TeleportState {
  double velocity_m_s[3] = {}, spin[3] = {};        // of the step that teleported last
  uint32_t carried_capsules = 0;                    // in the last step
  uint32_t root_teleports = 0, part_teleports = 0;  // since creation
  uint16_t teleported = 0;                          // the root, in the last step
  uint16_t told = 0;                                // Pose::teleport, of the pose set since
};

// ---- arrays ----

struct PoseHistory {
  // State.
  Matrix34* pose_joints[4] = {};  // [joints], in turn:
  Matrix34 *joints_older = nullptr, *joints_before = nullptr, *joints = nullptr,
           *next_joints = nullptr;  // point there
  tissue::NodePose* poses[3] = {};  // [nodes] of the last three ticks, newest first
  // Of joints, what teleported in the last step; what is carried over in the next tick.
  uint32_t *joint_teleports = nullptr, *carried_regions = nullptr, *carried_rods = nullptr;

  // Scratch of a step.
  JointParts *parts_older = nullptr, *parts_before = nullptr, *parts = nullptr,
             *next_parts = nullptr;  // [joints]
  RootStep root_step{}, root_step_before{};
  Matrix34* tick_joints = nullptr;        // [joints]
  tissue::NodePose* poses_now = nullptr;  // [nodes] at the end of the step
  float* skin = nullptr;  // [joints][12], where they are too many for a reader's stack; scratch of a tick
  float *joint_size = nullptr, *node_size = nullptr;  // [joints], [nodes]
  bool parts_ready = false;                           // in this step: the parts are filled in
  bool scaled_nodes = false;                          // in this tick: node_size is not 1 everywhere
};

void lay_out_state(const Asset& asset, core::Arena& arena, PoseHistory& to) noexcept;
void lay_out_scratch(const Asset& asset, core::Arena& arena, PoseHistory& to) noexcept;

}  // namespace sinew::world
