// drive_nodes.hpp  What nodes feel in a tick, from the poses.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// drive of this tick, from the poses.
void drive_nodes(Instance& instance) noexcept;

// How many times as large as bound the flesh of each node is, by PoseHistory::skin; null where all is as
// bound.
const float* size_nodes(const Instance& instance) noexcept;

}  // namespace sinew::world
