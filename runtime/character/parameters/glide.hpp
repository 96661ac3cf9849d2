// glide.hpp  A number on its way to what was set, tick by tick.
#pragma once
#include <algorithm>
#include <cmath>

#include "character/parameters/tuning_state.hpp"

namespace sinew::world {

// next, and its speed, a tick later: as a critically damped spring has it, whose half-way mark is 4.2 ticks
// away and of whose way 5 % are left after 12. Within `rounding` of the target it is there, exactly.
// From far away it goes by `fastest` a tick.
inline constexpr float kPace = 0.4f, kAnySpeed = 1e9f;
inline void glide(float target, float rounding, float fastest, Gliding& number) noexcept {
  constexpr float kKept = 0.67032005f;  // exp(-kPace)
  const float off = number.next - target, felt = std::clamp(off, -2 * fastest / kPace, 2 * fastest / kPace);
  const float way = number.speed + kPace * felt;
  const float left = off - felt + kKept * (felt + way), speed = kKept * (number.speed - kPace * way);
  const bool there = std::abs(left) < rounding && std::abs(speed) < rounding;
  number.next = there ? target : target + left;
  number.speed = there ? 0 : speed;
}

// Whether the coming tick has another than the last one had.
inline bool moves(const Gliding& number) noexcept { return number.next != number.now || number.speed != 0; }

inline bool stands_at(const Gliding& number, float value) noexcept {
  return number.now == value && number.next == value && number.speed == 0;
}

// By a fraction of the coming tick; exactly `now` where it stands.
inline float between(const Gliding& number, float x) noexcept {
  return number.now + x * (number.next - number.now);
}

}  // namespace sinew::world
