// test_tick_clock.cpp  Frames of any length give the same ticks at the same times.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "schedule/tick_clock.hpp"

using sinew::frame::exact_seconds;
using sinew::frame::plan_ticks;
using sinew::frame::TickPlan;

namespace {

constexpr double kTick_s = 1.0 / 60;
constexpr uint32_t kPlenty = 64;
constexpr double kTimeTolerance_s = 1e-9;  // sums of some hundred doubles of the size of a second

std::vector<double> tick_times(float dt_s, int frames) {
  std::vector<double> times;
  double remainder_s = 0, now_s = 0;
  for (int f = 0; f < frames; ++f) {
    const double dt = exact_seconds(dt_s);
    const TickPlan plan = plan_ticks(remainder_s, dt, kTick_s, kPlenty);
    for (uint32_t k = 0; k < plan.ticks; ++k) times.push_back(now_s + plan.first_tick_s + k * kTick_s);
    remainder_s = plan.remainder_s;
    now_s += dt;
  }
  return times;
}

}  // namespace

TEST_CASE("dt_that_is_no_time_counts_as_zero") {
  CHECK(exact_seconds(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(exact_seconds(-1) == 0);
  CHECK(exact_seconds(0) == 0);
  CHECK(exact_seconds(std::numeric_limits<float>::infinity()) == sinew::frame::kLongestStep_s);
  CHECK(exact_seconds(std::numeric_limits<float>::denorm_min()) > 0);
}

TEST_CASE("float_unit_fractions_are_taken_exactly") {
  for (int rate : {15, 24, 30, 50, 60, 72, 90, 120, 144, 165, 240, 1000}) {
    CHECK(exact_seconds(1.0f / static_cast<float>(rate)) == 1.0 / rate);
  }
  CHECK(exact_seconds(0.0123456f) == static_cast<double>(0.0123456f));
}

TEST_CASE("ticks_lie_on_one_grid_at_every_frame_rate") {
  for (int rate : {15, 24, 30, 50, 60, 72, 90, 120, 144, 165, 240, 1000}) {
    INFO("frames a second " << rate);
    const std::vector<double> times = tick_times(1.0f / static_cast<float>(rate), 3 * rate);
    REQUIRE(times.size() == 180);
    for (size_t k = 0; k < times.size(); ++k) {
      CHECK(std::abs(times[k] - static_cast<double>(k + 1) * kTick_s) < kTimeTolerance_s);
    }
  }
}

TEST_CASE("equal_frames_and_ticks_keep_phase_for_a_day") {
  double remainder_s = 0;
  const double dt = exact_seconds(1.0f / 60);
  bool one_each = true;
  for (int f = 0; f < 24 * 3600 * 60; ++f) {
    const TickPlan plan = plan_ticks(remainder_s, dt, kTick_s, kPlenty);
    one_each = one_each && plan.ticks == 1;
    remainder_s = plan.remainder_s;
  }
  CHECK(one_each);
}

TEST_CASE("time_beyond_the_cap_is_dropped_from_the_start_of_the_step") {
  const TickPlan plan = plan_ticks(0.01, 5, kTick_s, 4);
  CHECK(plan.ticks == 4);
  CHECK(plan.first_tick_s + 3 * kTick_s == Approx(5 - plan.remainder_s));
  CHECK(plan.dropped_s == Approx(5 + 0.01 - plan.remainder_s - 4 * kTick_s));
  CHECK(plan.remainder_s >= -1e-6);
  CHECK(plan.remainder_s < kTick_s);
}

TEST_CASE("no_time_no_tick") {
  const TickPlan plan = plan_ticks(0.01, 0, kTick_s, 4);
  CHECK(plan.ticks == 0);
  CHECK(plan.remainder_s == 0.01);
  CHECK(plan.dropped_s == 0);
}
