// retuned.cpp  see retuned.hpp.
#include "tissue/modes/retuned.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::tissue {
namespace {

// Of a mode and a tick: w h, and zeta.
struct Swing {
  double turn, damping_ratio;
};

// What it turns by in a tick as it swings; 0 where it creeps.
double angle_of(const Swing& swing) noexcept {
  return std::sqrt(std::max(0.0, 1 - swing.damping_ratio * swing.damping_ratio)) * swing.turn;
}

// 1 of what is slow, 0 of what is too fast to swing.
double share_that_swings(const Swing& swing) noexcept {
  const double t = std::clamp((angle_of(swing) - kFast) / (std::numbers::pi - kFast), 0.0, 1.0);
  return 1 - t * t * (3 - 2 * t);
}

// What the change makes less; nothing of what was baked as fast.
double kept_of(const Swing& baked, const Swing& now) noexcept {
  const double before = share_that_swings(baked), after = share_that_swings(now);
  return before > 0 ? std::min(1.0, after / before) : after;
}

Recurrence creep(const Swing& swing) noexcept {
  const double zeta = swing.damping_ratio, fast = zeta + std::sqrt(zeta * zeta - 1);
  const double r1 = std::exp(-swing.turn / fast), r2 = std::exp(-swing.turn * fast);
  return {static_cast<float>(r1 + r2), static_cast<float>(-r1 * r2)};
}

Recurrence recurrence_of(const Swing& baked, const Swing& now) noexcept {
  if (now.damping_ratio >= 1) return creep(now);
  const double r = kept_of(baked, now) * std::exp(-now.damping_ratio * now.turn);
  return {static_cast<float>(2 * r * std::cos(std::min(angle_of(now), std::numbers::pi))),
          std::max(std::nextafter(-1.0f, 0.0f), static_cast<float>(-r * r))};
}

Swing changed(const Swing& baked, const Retuning& by) noexcept {
  const double turn = std::sqrt(double{by.stiffness}) * baked.turn;
  return {turn, std::max(kLeastDampingRatio, double{by.damping} * baked.damping_ratio) +
                    double{by.stiffens} / (2 * turn)};
}

// z = r exp(+-i phi), or r exp(+-phi) where it creeps, is exp of h times the mode's own roots.
Swing swing_of(const Recurrence& recurrence) noexcept {
  const double r = std::sqrt(-double{recurrence.a2}), half = double{recurrence.a1} / (2 * r);
  const double decay = -std::log(r), phi = half < 1 ? std::acos(std::max(half, -1.0)) : std::acosh(half);
  const double turn = std::sqrt(std::max(decay * decay + (half < 1 ? 1 : -1) * phi * phi, 1e-12));
  return {turn, decay / turn};
}

}  // namespace

pack::ModeRecord retuned(const pack::ModeRecord& mode, const Retuning& by, float tick_s) noexcept {
  const Swing baked{double{mode.rad_per_s} * double{tick_s}, double{mode.damping_ratio}};
  const Swing now = changed(baked, by);
  const Recurrence recurrence = recurrence_of(baked, now);
  pack::ModeRecord out = mode;
  out.rad_per_s = static_cast<float>(now.turn / double{tick_s});
  out.damping_ratio = static_cast<float>(now.damping_ratio);
  out.a1 = recurrence.a1;
  out.a2 = recurrence.a2;
  out.gain = (1 - out.a1 - out.a2) / (out.rad_per_s * out.rad_per_s);
  return out;
}

Recurrence retuned(const Recurrence& baked, const Retuning& by) noexcept {
  constexpr float kAtOnce = 1e-12f;
  if (!(-baked.a2 > kAtOnce)) return baked;
  const Swing swing = swing_of(baked);
  return recurrence_of(swing, changed(swing, by));
}

}  // namespace sinew::tissue
