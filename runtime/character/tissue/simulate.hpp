// simulate.hpp  One tick of modes, or of modes under a network: from drive to u.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// u, l, theta and q of this tick. A network whose state is given up
// leaves the tick, and the tier, to the base (see kFallbackTicks). Sleeping regions stay as they are. False:
// the base's own numbers are not finite, and nothing of the state is of use any more.
bool simulate_tick(Instance& instance) noexcept;

}  // namespace sinew::world
