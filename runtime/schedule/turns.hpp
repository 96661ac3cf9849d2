// turns.hpp  Who has waited too long, in the order in which turns are given.
#pragma once
#include <bit>

#include "schedule/candidate.hpp"

namespace sinew::frame {

inline bool is_overdue(const Candidate& c) noexcept {
  const bool has = c.has > 0;
  return c.weight > 0 && ((has & (c.turn_left_s > 0)) | (!has & (c.waited_s > kLongestWait_s)));
}

// A turn that has begun is not broken off; then the longest wait first.
inline uint64_t order_of(const Candidate& c) noexcept {
  constexpr uint64_t kBegins = uint64_t{1} << 63;
  constexpr uint32_t kLongest = 0x7fffffff;  // floats that are not negative sort as their bits do
  const uint64_t wait = kLongest - std::bit_cast<uint32_t>(c.waited_s);
  return (c.has > 0 ? 0 : kBegins) | wait << 32 | c.slot;
}

}  // namespace sinew::frame
