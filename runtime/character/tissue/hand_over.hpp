// hand_over.hpp  Displacement handed to the modes: from a network, or from what was shown.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Most of the way to where modes alone would have gone since the network began, for its corrections would
// swing on in them: q, and what follows from it.
void take_back_corrections(Instance& instance) noexcept;

// A twentieth slower, for what a network held back would swing further in them.
void slow_modes(Instance& instance) noexcept;

// l, theta and q of a displacement that did not come from them: u is taken for l, at both ticks.
void lift_displacement(Instance& instance) noexcept;

}  // namespace sinew::world
