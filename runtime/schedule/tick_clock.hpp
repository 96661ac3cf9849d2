// tick_clock.hpp  Frame times to fixed ticks: the same ticks at 15 and at 240 frames a second.
#pragma once
#include <cstdint>

namespace sinew::frame {

// Ticks lie on the grid k x tick_s since creation, whatever the frames do. remainder_s is the time between
// the last tick and the end of the last step, 0 <= remainder_s < tick_s (less a rounding slack).
struct TickPlan {
  uint32_t ticks = 0;  // to simulate in this step
  double first_tick_s =
      0;                   // time of the first of them since the step's start; the others follow tick_s apart
  double remainder_s = 0;  // after this step
  double dropped_s = 0;    // time before first_tick_s that is not simulated
};

inline constexpr double kLongestStep_s = 1e6;  // a longer dt counts as this

// A float dt cannot say 1/60: the float nearest to 1/n s, n <= 100000, is taken for 1/n exactly, so that
// equal frames keep their phase to the ticks for days. NaN and negative: 0.
double exact_seconds(float dt_s) noexcept;

// How much of a tick has passed since the last one, 0 <= x < 1; 0 of next to nothing.
float passed_share(const TickPlan& plan, double tick_s) noexcept;

TickPlan plan_ticks(double remainder_s, double dt_s, double tick_s, uint32_t max_ticks) noexcept;

// The same for one after another: instances of an age have the same ticks, which are worked out once.
class TickPlans {
 public:
  TickPlans(double dt_s, uint32_t most) noexcept : dt_s_(dt_s), most_(most) {}
  // Of one whose time runs `scale` times as fast.
  const TickPlan& of(double remainder_s, double tick_s, double scale = 1) noexcept {
    if (remainder_s != remainder_s_ || tick_s != tick_s_ || scale != scale_) {
      plan_ = plan_ticks(remainder_s, scale * dt_s_, tick_s, most_);
      remainder_s_ = remainder_s;
      tick_s_ = tick_s;
      scale_ = scale;
    }
    return plan_;
  }

 private:
  double dt_s_, remainder_s_ = -1, tick_s_ = 0, scale_ = 1;
  uint32_t most_;
  TickPlan plan_;
};

}  // namespace sinew::frame
