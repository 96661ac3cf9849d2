// blend.hpp  What an instance shows: the network's displacement, its continuation without the network, and
// the way between them.
#pragma once
#include "world/instance.hpp"

namespace sinew::world {

// At the start of a step. Leaving the network begins a tail; coming back rebases the network's state on what
// is shown and begins a blend.
void enter_tier(Instance& instance, Tier tier) noexcept;

// A guard fired: the state is worthless. Fades what was shown last to skinning; then the network starts anew.
void restart(Instance& instance) noexcept;

// End of a tick: carries the tail on and shows the blend.
void show_tick(Instance& instance) noexcept;

}  // namespace sinew::world
