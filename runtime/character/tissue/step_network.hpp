// step_network.hpp  The networks of a tick: their inputs, their step, and what they remember.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// After the base's answer. False: a network's state is not sound and is given up, with the tier, for
// kFallbackTicks.
bool step_network(Instance& instance) noexcept;

// The network goes on from what was taken of its answer.
void take_back_to_network(Instance& instance) noexcept;

}  // namespace sinew::world
