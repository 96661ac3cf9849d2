// fraction_step.cpp  see fraction_step.hpp.
#include "tissue/frames/fraction_step.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/kernels.hpp"

namespace sinew::tissue {
namespace {

// Cubics of Hermite from x = 0 to 1.
struct Hermite {
  float begin, begin_slope, end, end_slope;
};
Hermite hermite(float x) noexcept {
  const float y = 1 - x;
  return {y * y * (1 + 2 * x), x * y * y, x * x * (3 - 2 * x), -x * x * y};
}

// What a recurrence makes of its last two values, its force, that of the last tick, and of what that added
// and is off by.
struct Shares {
  float now, before, force, last_force, added, off;
};
Shares shares_of(float a1, float a2, const SwingSlopes& slopes, const Hermite& cubic, float x) noexcept {
  const float now = cubic.begin + cubic.begin_slope * slopes.of_now + cubic.end * a1 +
                    cubic.end_slope * (slopes.of_now * a1 + slopes.of_before);
  const float before =
      cubic.begin_slope * slopes.of_before + cubic.end * a2 + cubic.end_slope * slopes.of_now * a2;
  const float rest = 1 - a1 - a2, stays = (1 - now - before) / rest;
  const float ends = -(slopes.of_now * (a1 + a2) + slopes.of_before) / rest;  // the slope of `stays` at x = 1
  const float force = 1 + (1.5f - ends) * x * (1 - x);
  return {now, before, force, stays - force * x * (1 + x) / 2, stays, cubic.begin + cubic.begin_slope * ends};
}

}  // namespace

// z^x of the recurrence's roots z = r exp(+-i phi), or r exp(+-phi) where it does not swing.
SwingSlopes swing_slopes(float a1, float a2) noexcept {
  // Slopes of a cubic that is to stay between its ends, nearly.
  constexpr double kLeast = -3, kMost = 1.5, kLeastRadius = 1e-3;
  const double r = std::sqrt(std::max(-double{a2}, kLeastRadius * kLeastRadius));
  const double half = double{a1} / (2 * r);
  double over_tan = 1, over_sin = 1;
  if (std::abs(half) < 1) {
    const double phi = std::acos(half);
    over_sin = phi / std::sin(phi);
    over_tan = over_sin * half;
  } else if (half > 1) {
    const double phi = std::acosh(half);
    over_sin = phi > 0 ? phi / std::sinh(phi) : 1;
    over_tan = over_sin * half;
  }
  return {static_cast<float>(std::clamp(std::log(r) + over_tan, kLeast, kMost)),
          static_cast<float>(std::clamp(-r * over_sin, kLeast, kMost))};
}

void take_force(const ModalBase& base, const float* heard, const TickForce& tick) noexcept {
  for (size_t k = 0; k < base.modes.size(); ++k) tick.q[k] = base.modes[k].gain * heard[base.padded + k];
  for (uint32_t i = 0; i < 3 * base.node_count; ++i) tick.r[i] = base.rest_gain * heard[i];
}

void fraction_answer(const ModalBase& base, const SwingSlopes* slopes, const float* heard,
                     const ModalState& state, const TickForce& tick, float x,
                     const ModalAnswer& answer) noexcept {
  const auto modes = static_cast<uint32_t>(base.modes.size());
  const float *rest = heard, *force = heard + base.padded;
  const Hermite cubic = hermite(x);
  for (uint32_t k = 0; k < modes; ++k) {
    const pack::ModeRecord& mode = base.modes[k];
    const Shares share = shares_of(mode.a1, mode.a2, slopes[k], cubic, x);
    answer.q[k] = share.now * state.q[k] + share.before * state.q_before[k] +
                  share.force * mode.gain * force[k] + share.last_force * tick.q[k] +
                  share.added * tick.added_q[k] + share.off * tick.off_q[k];
  }
  simd::kernels().add_rows(base.shape, modes, base.padded, answer.q, answer.l);
  const Shares share = shares_of(base.rest_a1, base.rest_a2, slopes[modes], cubic, x);
  const float gain = share.force * base.rest_gain;
  for (uint32_t i = 0; i < 3 * base.node_count; ++i) {
    answer.r[i] = share.now * state.r[i] + share.before * state.r_before[i] + gain * rest[i] +
                  share.last_force * tick.r[i] + share.added * tick.added_r[i] + share.off * tick.off_r[i];
    answer.l[i] += answer.r[i];
  }
}

}  // namespace sinew::tissue
