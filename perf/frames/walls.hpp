// walls.hpp  Walls along the front of the floor, as wide as the gaps between them: half of the crowd is
// hidden behind them.
#pragma once
#include <cstdint>
#include <memory>

#include "sinew/view.hpp"

namespace sinew::perf {

inline constexpr double kWalls_m = -1;  // where they stand, along Z

// sinew::Occluders; null in a build without Embree. Throws baker::BadInput.
std::unique_ptr<OcclusionSource> make_walls(uint32_t instances);

}  // namespace sinew::perf
