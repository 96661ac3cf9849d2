// simulate.hpp  One tick of modes, or of modes under a network: from drive to u.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

struct Part;

// drive of this tick, from the poses.
void drive_nodes(Instance& instance) noexcept;

// How many times as large as bound the flesh of each node is, by instance.skin; null where all is as bound.
const float* size_nodes(const Instance& instance) noexcept;

// theta that turns e: of the modal base alone, so that it hears nothing of what a network corrects while the
// frames do not turn (tissue/modes/correction_budget.hpp). Overwrites carry and region[0].
const float* theta_of_base(Instance& instance, const Part& part) noexcept;

// u, l, theta and q of this tick. A network whose state is given up
// leaves the tick, and the tier, to the base (see kFallbackTicks). Sleeping regions stay as they are. False:
// the base's own numbers are not finite, and nothing of the state is of use any more.
bool simulate_tick(Instance& instance) noexcept;

// Most of the way to where modes alone would have gone since the network began, for its corrections would
// swing on in them: q, and what follows from it.
void take_back_corrections(Instance& instance) noexcept;

// A twentieth slower, for what a network held back would swing further in them.
void slow_modes(Instance& instance) noexcept;

// l, theta and q of a displacement that did not come from them: u is taken for l, at both ticks.
void lift_displacement(Instance& instance) noexcept;

}  // namespace sinew::world
