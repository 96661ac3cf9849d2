// publish.hpp  The last tick's displacement brought to the render time and to the surface.
#pragma once
#include "world/instance.hpp"

namespace sinew::world {

// Fills skin, delta and carried from the present pose and what is shown.
//
// Between ticks the displacement is carried on at its last velocity: u + (r/h)(u_t - u_{t-1}), r the time
// since the last tick. Interpolating one tick late instead would be exact in shape but late by h: at 4 Hz a
// phase error of 2 pi 4 / 60 = 0.42 rad, some 40 % of the amplitude, on tissue that is seen beside a skeleton
// that is not late. The extrapolation's error is second order in the same angle.
void publish(Instance& instance) noexcept;

}  // namespace sinew::world
