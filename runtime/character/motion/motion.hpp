// motion.hpp  What an instance's tissue has lived through: poses at ticks, the history that accelerations are
// taken from.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Start of a step, before its ticks. Takes over the pose that was set (or holds the present one).
//   first pose after create or reset: counts as having been held for ever
//   a teleport is carried over (character/motion/teleport.hpp)
void take_pose(Instance& instance, const TeleportDef& teleport) noexcept;

// End of a step: the pose that was set is the present one.
void keep_pose(Instance& instance) noexcept;

// Brings skin, poses and tick_root_m to `time_s` after the step's start. Where ticks were not followed
// (motion_stale), the two before are first rebuilt on the line between the two poses: no acceleration, no
// spike.
void follow_motion(Instance& instance, double time_s) noexcept;

// Frames of the nodes, and skin, at the pose that the last step ended with. Into the newest of `poses`, where
// ticks were not followed, they are the frames that tissue comes back in.
void pose_now(Instance& instance, tissue::NodePose* out) noexcept;

}  // namespace sinew::world
