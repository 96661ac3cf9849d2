// pose_bound.hpp  A ball about a character in the pose that was set last.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// How far a vertex may be from the joint that moves it most: its distance in the bind pose, what soft parts
// may be displaced by, and both ways of the longest rod.
// Refused: no memory.
Status measure_reach(const Asset& asset, float* out_m) noexcept;

// Of the pose that was set last, in the world: about the middle of the joints' box, its half diagonal with
// the asset's reach and a fifth of it for joints that stretch. Into `bound`.
void bound_pose(Instance& instance) noexcept;

}  // namespace sinew::world
