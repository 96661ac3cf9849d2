// blend.hpp  What an instance shows: simulated displacement, its continuation without simulation, and the way
// between them.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// At the start of a step. Leaving simulation begins a tail; coming back begins a blend, from what is shown
// or, after more ticks than are caught up with, from rest under the load. Modes and network hand their
// displacement on to each other without one.
void enter_tier(Instance& instance, Tier tier) noexcept;

// A guard fired: the state is worthless. Fades what was shown last to skinning; then simulation starts anew.
void restart(Instance& instance) noexcept;

// Where the tail will be by a fraction x of the next tick: it is met there, with the velocities of before and
// after.
void tail_between(Instance& instance, float x, float* out) noexcept;

// End of a tick: carries the tail on and shows the blend.
void show_tick(Instance& instance) noexcept;

// As after so many ticks that the tail has faded.
void show_nothing(Instance& instance) noexcept;

}  // namespace sinew::world
