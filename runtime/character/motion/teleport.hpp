// teleport.hpp  Discontinuities of a pose: what goes further in a step than motion does is carried, unfelt.
//
// The root, or a joint beside it, jumps where it ends further than TeleportDef allows from where its velocity
// of the last step would have brought it. Its past, the poses that the step and the one before ended with, is
// then moved so that it leads to the coming pose at that velocity. Where the step after it is much slower or
// faster, that step's own velocity takes its place, for a jump tells nothing of how the motion goes on. Ticks
// lie between these poses. With the root all of the history of ticks moves as a rigid body; where a joint
// jumps, the soft parts whose nodes and the rods whose bones it moves have theirs rebuilt from the poses
// (character/motion/motion.cpp). So one rule covers cuts, snap turns, clips that loop their travel, pauses,
// mirrored and scaled poses, and one joint.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// What counts as one in a step, of dt_s: heights in metres.
struct TeleportBounds {
  double distance_m, angle_rad, scale_log;
};
TeleportBounds teleport_bounds(const TeleportDef& def, float height_m, double dt_s) noexcept;

// Before a step's velocity is measured, where a pose was set. Marks carried_regions and carried_rods, or has
// all of the history rebuilt. Cost: a difference a joint; more where something jumps.
void carry_teleports(Instance& instance, const TeleportDef& def) noexcept;

// All rods, over ticks that are not followed.
void carry_rods(Instance& instance) noexcept;
// All of the history is put on the coming step's line: its velocity is taken to have been there before.
void begin_line(Instance& instance) noexcept;
// As if nothing had teleported yet.
void forget_teleports(Instance& instance) noexcept;

// For the next tick; forget_carried after it.
bool carries_parts(const Instance& instance) noexcept;
void forget_carried(Instance& instance) noexcept;

}  // namespace sinew::world
