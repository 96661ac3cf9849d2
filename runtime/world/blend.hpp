// blend.hpp  What an instance shows: simulated displacement, its continuation without simulation, and the way
// between them.
#pragma once
#include "world/instance.hpp"

namespace sinew::world {

// At the start of a step. Leaving simulation begins a tail; coming back begins a blend, from what is shown
// or, after more ticks than are caught up with, from rest under the load. Modes and network hand their
// displacement on to each other without one.
void enter_tier(Instance& instance, Tier tier) noexcept;

// A guard fired: the state is worthless. Fades what was shown last to skinning; then simulation starts anew.
void restart(Instance& instance) noexcept;

// What is simulated in a tick, 0 the newest, along the axes of the flesh: what is shown of it where nothing
// blends. [nodes][3]
void take_simulated(const Instance& instance, int tick, float* out) noexcept;

// What a change of level had again is shown less of, in nodes' vectors along the axes of the flesh.
// x: so far beyond the last tick.
void keep_regained_share(const Instance& instance, float* shown, float x = 0) noexcept;

// Where the tail will be by a fraction x of the next tick: it is met there, with the velocities of before and
// after.
void tail_between(Instance& instance, float x, float* out) noexcept;

// End of a tick: carries the tail on and shows the blend.
void show_tick(Instance& instance) noexcept;

// As after so many ticks that the tail has faded.
void show_nothing(Instance& instance) noexcept;

}  // namespace sinew::world
