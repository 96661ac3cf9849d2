// blue_noise.hpp  A tile of numbers in which neighbours differ: used as pixel offsets, it makes sampling
// noise fine-grained.
#pragma once
#include <array>
#include <cstdint>

namespace sinew::render {

inline constexpr int kNoiseTile = 64;

// Each of 0 .. 1 in steps of 1/4096 once; made on first use, the same on every run. Any x and y: the tile
// repeats.
float blue_noise(uint32_t x, uint32_t y);

}  // namespace sinew::render
