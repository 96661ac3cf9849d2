// shares.hpp  How much of what is simulated, of the tail and of what a change of level left is shown.
//
// `ahead`: in ticks beyond the last, as far as the blend goes on at its last pace.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Of what is shown.
struct ShownShares {
  float simulated, tail;
};

float simulated_share(const Instance& instance, float ahead = 0) noexcept;  // b
// 1 while carried, then falling smoothly to 0.
float tail_share(const Instance& instance, float ahead = 0) noexcept;
// 1 as a level changes, then falling smoothly to 0.
float seam_share(const Instance& instance) noexcept;
// Of what is simulated, 1 but for a region that a change of level had again: it rises as the seam falls.
float regained_share(const Instance& instance, size_t region, float ahead = 0) noexcept;
ShownShares shown_shares(const Instance& instance, float ahead = 0) noexcept;
float shown_share(const Instance& instance) noexcept;  // of displacement, 0: skinning

}  // namespace sinew::world
