// retuned.hpp  Modes of flesh that is stiffer or damped otherwise than it was baked.
//
// Of a mode w, zeta, with s the stiffness's and d the damping ratio's share of the baked ones and h a tick:
//   w' = sqrt(s) w,   zeta' = max(d zeta, kLeastDampingRatio),   roots r exp(+-i phi) of w', zeta' in a tick
//   a1 = 2 r cos phi,   a2 = -r^2,   gain = (1 - a1 - a2) / w'^2
// so that a load that lasts moves it by 1 / s of what it did. In a tick in which s rises by a factor exp(g)
// zeta' is g / (2 w' h) more: springs that become stiffer while they are bent hand energy to what swings,
// which would be flung; twice as much damping as takes that energy holds it. What swings faster than half the
// tick's rate answers at once (a1 = a2 = 0), as a baker has it; what is made so fast gets there smoothly, for
// near that rate a mode would turn over in every tick: from kFast radians a tick on r is faded out.
#pragma once
#include "pack/format.hpp"

namespace sinew::tissue {

inline constexpr double kLeastDampingRatio = 0.002, kFast = 1.5;

// Shares of what was baked, s and d; above 0, and 0 or more. stiffens: g, 0 or more.
struct Retuning {
  float stiffness = 1, damping = 1;
  float stiffens = 0;
};

// The mode's last two values' shares in the next.
struct Recurrence {
  float a1 = 0, a2 = 0;
};

pack::ModeRecord retuned(const pack::ModeRecord& mode, const Retuning& by, float tick_s) noexcept;

// Of a recurrence alone, w and zeta as its roots tell them. One that answers at once does so at every
// stiffness.
Recurrence retuned(const Recurrence& baked, const Retuning& by) noexcept;

}  // namespace sinew::tissue
