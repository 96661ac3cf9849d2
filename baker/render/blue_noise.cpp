// blue_noise.cpp  see blue_noise.hpp.
#include "baker/render/blue_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace sinew::render {
namespace {

constexpr int kCount = kNoiseTile * kNoiseTile;
constexpr int kReach = 4;      // pixels
constexpr float kBlur = 1.6f;  // pixels, standard deviation
constexpr int kRounds = 12;    // the spectrum no longer changes visibly after ten

using Tile = std::vector<float>;

size_t wrap(int x, int y) {
  return static_cast<size_t>((y & (kNoiseTile - 1)) * kNoiseTile + (x & (kNoiseTile - 1)));
}

Tile blurred(const Tile& tile, int dx, int dy) {
  Tile out(kCount, 0.0f);
  for (int offset = -kReach; offset <= kReach; ++offset) {
    const float weight = std::exp(-static_cast<float>(offset * offset) / (2 * kBlur * kBlur));
    for (int y = 0; y < kNoiseTile; ++y) {
      for (int x = 0; x < kNoiseTile; ++x)
        out[wrap(x, y)] += weight * tile[wrap(x + offset * dx, y + offset * dy)];
    }
  }
  return out;
}

// Back to a flat distribution: every value becomes its rank.
void flatten(Tile* tile) {
  std::vector<size_t> order(kCount);
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return (*tile)[a] < (*tile)[b]; });
  for (size_t rank = 0; rank < order.size(); ++rank) (*tile)[order[rank]] = static_cast<float>(rank) / kCount;
}

// White noise, its low frequencies taken away again and again.
Tile make_tile() {
  Tile tile(kCount);
  std::mt19937 random(1);
  for (float& value : tile) value = static_cast<float>(random() >> 8);
  flatten(&tile);
  for (int round = 0; round < kRounds; ++round) {
    const Tile smooth = blurred(blurred(tile, 1, 0), 0, 1);
    constexpr float kSum = 2 * 3.1415927f * kBlur * kBlur;  // of the blur's weights
    for (size_t i = 0; i < tile.size(); ++i) tile[i] -= smooth[i] / kSum;
    flatten(&tile);
  }
  return tile;
}

}  // namespace

float blue_noise(uint32_t x, uint32_t y) {
  static const Tile tile = make_tile();
  return tile[wrap(static_cast<int>(x & (kNoiseTile - 1)), static_cast<int>(y & (kNoiseTile - 1)))];
}

}  // namespace sinew::render
