// yardstick.hpp  How far a way to run a character is from the truth.
#pragma once
#include <span>
#include <vector>

#include "baker/measure/closed_loop.hpp"
#include "baker/measure/true_surface.hpp"

namespace sinew::baker {

// Over all vertices that tissue moves and some ticks of all motions, millimetres. ratio: to what skinning
// alone is off at the same ticks. Extrapolate: of the ticks told of it.
struct Spread {
  double mean_mm = 0, sd_mm = 0, p95_mm = 0, worst_mm = 0, ratio = 0;
};
// Of ticks 1 .. 600, and of the first 50 of them.
struct Error : Spread {
  Spread in_50;
  std::vector<double> ratios = {};  // a motion; NaN: next to the liveliest nothing moves in it
};

inline constexpr size_t kMostTicks = 600;
// Extrapolate is told of so many ticks after the last simulated one: where its fade to skinning begins.
inline constexpr size_t kCarriedTicks = 4;

// What all ways are measured against. The surfaces must outlive it.
class Yardstick {
 public:
  // Throws BadInput when nothing of the motions moves.
  Yardstick(const LoadedPack& character, std::span<const TrueSurface> surfaces);

  Error of_skinning() const;
  // The true displacement of the tick before, turned with the skin.
  Error of_previous_frame() const;
  // In closed loop from the motions' start.
  Error of(const LoadedPack& character, Tier tier, uint32_t level) const;
  // So many ticks after a character in its best tier was left alone, again and again.
  Error of_extrapolation(const LoadedPack& character, size_t ticks) const;

 private:
  class Sums;
  void skin(const LoadedPack& character, size_t motion);

  std::span<const TrueSurface> surfaces_;
  const float* truth(size_t motion, size_t tick, size_t vertex) const;

  std::vector<uint32_t> vertices_;               // that tissue moves
  std::vector<size_t> region_;                   // of each
  std::vector<std::vector<float>> truth_;        // [motion][tick][vertex][3], within the regions' limits
  std::vector<std::vector<float>> skinning_mm_;  // [motion][tick][vertex]
  std::vector<std::vector<float>> previous_mm_;  // likewise
};

}  // namespace sinew::baker
