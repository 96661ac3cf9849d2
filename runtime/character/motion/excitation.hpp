// excitation.hpp  How much a motion moves an instance's tissue, so that a budget goes where something is
// seen.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Root mean square of the shown displacement as a share of what skinning is off on average, smoothed over a
// third of a second, kLeastExcitation..kMostExcitation. What is not simulated is not known: it returns to 1
// in some seconds, so that it is tried.
inline constexpr float kLeastExcitation = 0.1f, kMostExcitation = 8;

// After a step's ticks. Cost: one pass over the nodes where something is simulated.
void follow_excitation(Instance& instance) noexcept;

}  // namespace sinew::world
