// weight_buckets.hpp  Positive floats sorted into drawers of a sixteenth of an octave, largest first, in one
// pass.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

namespace sinew::frame {

// Sums of what lies in each drawer. Floats above zero sort as their bits do: the upper bits are the drawer.
class WeightBuckets {
 public:
  static constexpr uint32_t kCount = 4096;
  static constexpr uint32_t kFineInADrawer = 8;
  // 0 holds what is zero, negative or no number.
  static uint32_t drawer_of(float key) noexcept { return fine_drawer_of(key) / kFineInADrawer; }
  static constexpr uint32_t fine_drawer_of(float key) noexcept {
    return key > 0 ? std::bit_cast<uint32_t>(key) >> kFineShift : 0;
  }
  // The smallest key of a fine drawer.
  static constexpr float begin_of(uint32_t fine_drawer) noexcept {
    return std::bit_cast<float>(fine_drawer << kFineShift);
  }

  void clear() noexcept {
    if (first_ <= last_) std::fill(sums_ + first_, sums_ + last_ + 1, 0.0);
    first_ = kCount - 1, last_ = 0;
  }
  void add(uint32_t drawer, double amount) noexcept {
    sums_[drawer] += amount;
    first_ = std::min(first_, drawer);
    last_ = std::max(last_, drawer);
  }
  // The lowest drawer such that it and all above it add up to `most` at most; one above the highest where not
  // even that fits.
  uint32_t lowest_within(double most) const noexcept {
    uint32_t lowest = last_ + 1;
    for (double sum = 0; lowest > first_ && sum + sums_[lowest - 1] <= most; --lowest)
      sum += sums_[lowest - 1];
    return lowest;
  }

 private:
  static constexpr uint32_t kFineShift = 16;  // of a float's bits; sixteen drawers of eight an octave
  double sums_[kCount] = {};
  uint32_t first_ = kCount - 1, last_ = 0;
};

}  // namespace sinew::frame
