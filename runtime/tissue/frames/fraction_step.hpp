// fraction_step.hpp  A soft part between two ticks: where its next tick would have it by a fraction x of it.
//
// In 0 <= x <= 1 from tick t-1 (x = 0) to tick t (x = 1), the poses of the last two ticks and the present one
// known. At x = 1 it is the tick's own step (tissue/modes/modal_base.hpp), at x = 0 what that begins with:
//
//   D = p(x) - (1 + x) p_{t-1} + x p_{t-2}       of places p; phi likewise, u going on in the world
//
//   felt = R^T (-D / h^2) + b gravity(x) - (b - s) gravity_{t-1}
//
//   s = x (1 + x) / 2,   b = 1 - 3/2 x (1 - x),   w = 1 + (3/2 - E'(1)) x (1 - x)
//
//   q(x) = A q_{t-1} + B q_{t-2} + E (F + added) + w (gain force e - s F) + o off,   r(x) likewise
//
// A and B are the cubics of x from 1 to a1 and from 0 to a2 whose slopes at both ends are those of the free
// swing, and E = (1 - A - B) / (1 - a1 - a2), so that what a force holds stays. F is what the last tick's
// force answered with, and `added` what it added to the base's answer, a network's correction or the push of
// what is touched; both are taken to go on. An impulse a tick, which is what a tick's force is, so becomes a
// force that lasts: whatever A'(0) and B'(0) are, the slope of q at x = 1 is that at x = 0 of the next tick,
// if the path of the poses has a slope there; exactly while frames and theta do not turn.
//
// That the last tick did not add what the one before had is seen at x = 0 where fractions of that one were
// shown: `off` is what was added before less what was then. o takes it back, from 1 with the slope E'(1) to 0
// without.
#pragma once
#include "tissue/modes/modal_base.hpp"

namespace sinew::tissue {

// A'(0) and B'(0) of a recurrence.
struct SwingSlopes {
  float of_now = 0, of_before = 0;
};
// Of any stable recurrence; of a mode w, zeta of which a tick swings less than a quarter: exact.
SwingSlopes swing_slopes(float a1, float a2) noexcept;

// Of a tick, q [modes] and r [node_count][3] each; off is the next one's.
struct TickForce {
  float *q, *r;              // force
  float *added_q, *added_r;  // added
  float *off_q, *off_r;
};
void take_force(const ModalBase& base, const float* heard, const TickForce& tick) noexcept;

// What heard leads to by the fraction, as modal_answer; heard by modal_hear, from f
// (tissue/frames/node_drive.hpp) and phi of the fraction. slopes: [modes], then of rest. 0 <= x <= 1.
void fraction_answer(const ModalBase& base, const SwingSlopes* slopes, const float* heard,
                     const ModalState& state, const TickForce& tick, float x,
                     const ModalAnswer& answer) noexcept;

}  // namespace sinew::tissue
