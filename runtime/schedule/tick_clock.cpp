// tick_clock.cpp  Frame times to fixed ticks.
#include "schedule/tick_clock.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::frame {
namespace {

// Sums of exact dt in double err by 1e-16 s a frame; a tick may come this share of a tick early, never a
// frame late.
constexpr double kSlack = 1e-6;

}  // namespace

double exact_seconds(float dt_s) noexcept {
  constexpr double kLargestRate = 1e5;
  if (!(dt_s > 0)) return 0;
  const double dt = std::min(static_cast<double>(dt_s), kLongestStep_s);
  const double rate = std::round(1 / dt);
  const bool unit_fraction = rate >= 1 && rate <= kLargestRate && static_cast<float>(1 / rate) == dt_s;
  return unit_fraction ? 1 / rate : dt;
}

float passed_share(const TickPlan& plan, double tick_s) noexcept {
  constexpr double kNothing = 1e-4;
  const double share = plan.remainder_s / tick_s;
  return share < kNothing ? 0 : static_cast<float>(share);
}

TickPlan plan_ticks(double remainder_s, double dt_s, double tick_s, uint32_t max_ticks) noexcept {
  const double total_s = remainder_s + dt_s;
  const double due = std::floor(total_s / tick_s + kSlack);
  TickPlan plan;
  plan.ticks = static_cast<uint32_t>(std::clamp(due, 0.0, static_cast<double>(max_ticks)));
  plan.dropped_s = std::max(0.0, (due - plan.ticks) * tick_s);
  plan.first_tick_s = (due - plan.ticks + 1) * tick_s - remainder_s;
  plan.remainder_s = total_s - std::max(0.0, due) * tick_s;
  return plan;
}

}  // namespace sinew::frame
