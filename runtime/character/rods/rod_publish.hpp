// rod_publish.hpp  Rods at the render time, as joint matrices.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Each bone turns about where it begins, as its segment is turned against its rest, and moves all that hangs
// on it; lengths and scales are the pose's. turns: [slots][4], as rod_shown.
void publish_rods(Instance& instance, const float* turns) noexcept;

// Of the present pose, rods applied.
inline const Matrix34* shown_joints(const Instance& instance) noexcept {
  return instance.rods.are_shown ? instance.rods.joints : instance.motion.joints;
}

}  // namespace sinew::world
