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
  // 0 holds what is zero, negative or no number.
  static uint32_t drawer_of(float key) noexcept {
    constexpr uint32_t kMantissaBits = 23, kDrawerBits = 4;
    return key > 0 ? std::bit_cast<uint32_t>(key) >> (kMantissaBits - kDrawerBits) : 0;
  }

  void clear() noexcept {
    if (first_ <= last_) std::fill(sums_ + first_, sums_ + last_ + 1, 0.0f);
    first_ = kCount - 1, last_ = 0;
  }
  void add(uint32_t drawer, float amount) noexcept {
    sums_[drawer] += amount;
    first_ = std::min(first_, drawer);
    last_ = std::max(last_, drawer);
  }
  // The lowest drawer such that it and all above it add up to `most` at most, and what is left of that; one
  // above the highest where not even that fits.
  uint32_t lowest_within(double most, double* left) const noexcept {
    uint32_t lowest = last_ + 1;
    for (*left = most; lowest > first_ && sums_[lowest - 1] <= *left; --lowest) *left -= sums_[lowest - 1];
    return lowest;
  }
  bool has_below(uint32_t drawer) const noexcept { return drawer > first_; }

 private:
  float sums_[kCount] = {};
  uint32_t first_ = kCount - 1, last_ = 0;
};

}  // namespace sinew::frame
