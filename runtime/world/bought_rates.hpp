// bought_rates.hpp  Which update rates the scheduler buys.
#pragma once
#include <cstdint>

namespace sinew::world {

// Going to or from every second tick is seen as a jump (perf_jumps --rates), and coarser graphs at every tick
// cost as little.
inline constexpr uint32_t kMostEvery = 1;

}  // namespace sinew::world
