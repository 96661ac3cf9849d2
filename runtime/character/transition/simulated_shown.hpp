// simulated_shown.hpp  What is shown of what is simulated, where nothing blends.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// What is simulated in a tick, 0 the newest, along the axes of the flesh: what is shown of it where nothing
// blends. [nodes][3]
void take_simulated(const Instance& instance, int tick, float* out) noexcept;

// What a change of level had again is shown less of, in nodes' vectors along the axes of the flesh.
// x: so far beyond the last tick.
void keep_regained_share(const Instance& instance, float* shown, float x = 0) noexcept;

}  // namespace sinew::world
