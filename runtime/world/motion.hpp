// motion.hpp  What an instance's tissue has lived through: poses at ticks, teleports, the history that
// accelerations are taken from.
#pragma once
#include "world/instance.hpp"

namespace sinew::world {

// Start of a step, before its ticks. Takes over the pose that was set (or holds the present one).
//   first pose after create or reset: counts as having been held for ever
//   teleport: the root is further than teleport_distance_m from where its velocity of the last step would
//   have brought it, at any frame rate. The past (previous root, motion history) is moved rigidly so that it
//   leads to the new root at that same velocity: tissue keeps its shape and feels nothing of the jump.
//   A second one in the next step is no jump but a velocity that was none: it is forgotten first.
void take_pose(Instance& instance, float teleport_distance_m) noexcept;

// End of a step: the pose that was set is the present one.
void keep_pose(Instance& instance) noexcept;

// Brings skin, poses and tick_root_m to `time_s` after the step's start. Where ticks were not followed
// (motion_stale), the two before are first rebuilt on the line between the two poses: no acceleration, no
// spike.
void follow_motion(Instance& instance, double time_s) noexcept;

// Frames of the nodes at the pose that the last step ended with, into the newest of `poses`: where ticks were
// not followed, the frames that tissue comes back in.
void pose_at_start(Instance& instance) noexcept;

}  // namespace sinew::world
