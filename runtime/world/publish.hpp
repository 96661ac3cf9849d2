// publish.hpp  The last tick's displacement brought to the render time and to the surface.
#pragma once
#include "world/instance.hpp"

namespace sinew::world {

// Fills delta and carried from what is shown, and skin from the present pose where there are too many joints
// for whoever reads to skin them on its stack: what nobody reads is not skinned.
//
// Between ticks the displacement is carried on at its last velocity: u + (r/h)(u_t - u_{t-1}), r the time
// since the last tick. Interpolating one tick late instead would be exact in shape but late by h: at 4 Hz a
// phase error of 2 pi 4 / 60 = 0.42 rad, some 40 % of the amplitude, on tissue that is seen beside a skeleton
// that is not late. The extrapolation's error is second order in the same angle.
void publish(Instance& instance) noexcept;

inline constexpr uint32_t kJointsOnStack = 256;  // 12 KB
inline bool skins_on_reading(const Instance& instance) noexcept {
  return instance.level->pack.character->joint_count <= kJointsOnStack;
}

}  // namespace sinew::world
