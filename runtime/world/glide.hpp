// glide.hpp  A number on its way to what was set, tick by tick.
#pragma once
#include <cmath>

#include "world/tuning_state.hpp"

namespace sinew::world {

// next, and its speed, a tick later: as a critically damped spring has it, whose half-way mark is 3.4 ticks
// away and of whose way 2 % are left after 12. Within `rounding` of the target it is there, exactly.
inline void glide(float target, float rounding, Gliding& number) noexcept {
  constexpr float kPace = 0.5f, kKept = 0.60653066f;  // exp(-kPace)
  const float off = number.next - target, way = number.speed + kPace * off;
  const float left = kKept * (off + way), speed = kKept * (number.speed - kPace * way);
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
