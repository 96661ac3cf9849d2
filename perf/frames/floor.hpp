// floor.hpp  Where the characters of a scene stand: in a square, row by row.
#pragma once
#include <cmath>
#include <cstdint>

#include "sinew/types.hpp"

namespace sinew::perf {

inline constexpr double kSpacing_m = 1.5;

inline uint32_t in_a_row(uint32_t count) {
  return static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
}
inline double side_of_floor_m(uint32_t count) { return kSpacing_m * (in_a_row(count) - 1); }

inline RootTransform place_on_floor(uint32_t index, uint32_t count) {
  const uint32_t row = in_a_row(count);
  return {.position_m = {kSpacing_m * (index % row), 0, kSpacing_m * (index / row)}};
}

}  // namespace sinew::perf
