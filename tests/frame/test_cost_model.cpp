// test_cost_model.cpp  Estimates follow the clock, and one preempted measurement does not throw them.
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "schedule/cost_model.hpp"

using sinew::frame::Capacity;
using sinew::frame::CostEstimate;
using sinew::frame::CostModel;

namespace {

void measure(CostEstimate& cost, float sample_us) {
  cost.observe(sample_us);
  cost.settle();
}

}  // namespace

TEST_CASE("cost_estimate_ignores_samples_that_are_no_times") {
  CostEstimate cost(10);
  measure(cost, std::numeric_limits<float>::quiet_NaN());
  measure(cost, std::numeric_limits<float>::infinity());
  measure(cost, -1);
  CHECK(cost.estimate_us() == 10);
}

TEST_CASE("cost_estimate_reaches_the_measured_cost_in_a_second_of_frames") {
  CostEstimate cost(10);
  for (int f = 0; f < 60; ++f) measure(cost, 35);
  CHECK(cost.estimate_us() == Approx(35).epsilon(0.02));
  for (int f = 0; f < 60; ++f) measure(cost, 3);
  CHECK(cost.estimate_us() == Approx(3).epsilon(0.02));
}

TEST_CASE("one_preempted_sample_moves_the_estimate_by_an_eighth_at_most") {
  CostEstimate cost(10);
  measure(cost, 1e6f);
  CHECK(cost.estimate_us() <= 10 * (1 + 1.0f / 8) + 1e-4f);
}

TEST_CASE("many_samples_of_a_step_count_as_their_mean") {
  CostEstimate cost(10);
  for (int i = 0; i < 100; ++i) cost.observe(12);
  cost.settle();
  CHECK(cost.estimate_us() == Approx(10 + 2.0f / 8));
}

TEST_CASE("cost_estimate_starts_from_the_first_sample_where_nothing_was_baked") {
  CostEstimate cost;
  CHECK_FALSE(cost.is_known());
  measure(cost, 7);
  CHECK(cost.estimate_us() == 7);
  CHECK(cost.is_known());
}

TEST_CASE("unmeasured_estimate_drifts_back_to_the_baked_cost") {
  CostEstimate cost(10);
  for (int f = 0; f < 60; ++f) measure(cost, 1000);
  const float high = cost.estimate_us();
  REQUIRE(high > 900);
  for (int f = 0; f < 600; ++f) cost.settle();
  CHECK(cost.estimate_us() < 20);
}

// A preempted sample counts as any other that is above.
TEST_CASE("p95_lies_above_nineteen_of_twenty_samples_and_is_not_thrown") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(8, 16);
  CostEstimate cost(10);
  uint32_t above = 0;
  constexpr uint32_t kWarm = 1000, kSamples = 6000;
  for (uint32_t i = 0; i < kWarm + kSamples; ++i) {
    const float sample = i % 100 == 0 ? 1e5f : noise(random);
    if (i >= kWarm) above += sample > cost.p95_us();
    measure(cost, sample);
  }
  WARN("above p95: " << 100.0 * above / kSamples << " %");
  CHECK(above > kSamples / 40);
  CHECK(above < kSamples / 10);
  CHECK(cost.p95_us() < 25);
}

TEST_CASE("capacity_grows_while_threads_leave_time_and_shrinks_when_late") {
  Capacity capacity;
  for (int f = 0; f < 100; ++f) capacity.observe(0.3f, 0, true);
  const float grown = capacity.scale();
  CHECK(grown > 2);
  capacity.observe(1.1f, 0, true);
  CHECK(capacity.scale() < grown);
  for (int f = 0; f < 1000; ++f) capacity.observe(100, 1, true);
  CHECK(capacity.scale() == 0.05f);
}

TEST_CASE("a_lost_worker_is_noticed_within_a_tenth_of_a_second") {
  Capacity capacity;
  for (int f = 0; f < 100; ++f) capacity.observe(0.5f, 0, true);
  const float both = capacity.scale();
  for (int f = 0; f < 6; ++f) {
    const float fits = both / 2 / capacity.scale();
    capacity.observe(1, std::max(0.0f, 1 - fits), true);
  }
  CHECK(capacity.scale() < 0.6f * both);
}

TEST_CASE("one_preempted_frame_takes_little_capacity") {
  Capacity capacity;
  for (int f = 0; f < 10; ++f) capacity.observe(0.98f, 0, true);
  const float before = capacity.scale();
  capacity.observe(3, 0.9f, true);
  CHECK(capacity.scale() > 0.97f * before);
}

// Noise of 3 % about what was planned: the scale settles where few frames are late and little is left
// unspent.
TEST_CASE("capacity_settles_where_few_frames_are_late_and_little_is_left") {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(1, 0.03f);
  Capacity capacity;
  uint32_t late = 0;
  double spent_sum = 0;
  constexpr int kFrames = 20000;
  for (int f = 0; f < kFrames; ++f) {
    const float spent = 1.2f * capacity.scale() * noise(random);
    late += spent > 1;
    spent_sum += static_cast<double>(std::min(spent, 1.0f));
    capacity.observe(std::min(spent, 1.0f), std::max(0.0f, spent - 1), true);
  }
  WARN("late " << 100.0 * late / kFrames << " %, spent " << 100 * spent_sum / kFrames << " %");
  CHECK(late < kFrames / 20);
  CHECK(spent_sum > 0.93 * kFrames);
}

TEST_CASE("capacity_stays_where_nothing_was_denied") {
  Capacity capacity;
  const float before = capacity.scale();
  for (int f = 0; f < 100; ++f) capacity.observe(0.3f, 0, false);
  CHECK(capacity.scale() == before);
}

TEST_CASE("a_tail_too_wide_to_be_scheduled_is_forgotten_and_tried_again") {
  CostEstimate estimate(10);
  for (int step = 0; step < 400; ++step) {
    estimate.observe(step % 2 == 0 ? 10 : 30);
    estimate.settle();
  }
  REQUIRE(estimate.p95_us() > 1.4f * estimate.estimate_us());
  for (int step = 0; step < 300; ++step) estimate.settle();  // five seconds
  CHECK(estimate.p95_us() < 1.3f * estimate.estimate_us());
}

// Two seconds: longer than a tier that was too dear is left alone.
TEST_CASE("what_was_dear_is_kept_in_mind_while_the_estimate_falls_back") {
  CostEstimate cost(1);
  for (int f = 0; f < 100; ++f) measure(cost, 10);
  const float p95_us = cost.p95_us(), p99_us = cost.p99_us();
  for (int f = 0; f < 100; ++f) cost.settle();
  CHECK(cost.estimate_us() < 5);
  CHECK(cost.p95_us() == p95_us);
  CHECK(cost.p99_us() == p99_us);
  measure(cost, 5);
  CHECK(cost.p95_us() < p95_us);
}

TEST_CASE("an_estimate_that_has_drifted_for_long_learns_in_one_sample_half_of_what_is_new") {
  CostEstimate cost(10);
  for (int f = 0; f < 100; ++f) cost.settle();
  measure(cost, 18);
  CHECK(cost.estimate_us() == Approx(14));
  measure(cost, 18);
  CHECK(cost.estimate_us() == Approx(14 + 4.0 / 8));
}

TEST_CASE("what_one_preempted_change_of_level_took_does_not_stand_in_the_way_for_ever") {
  CostModel cost;
  cost.change.observe(1000);
  cost.settle();
  REQUIRE(cost.change.estimate_us() == 1000);
  for (int f = 0; f < 60; ++f) cost.settle();
  CHECK(cost.change.estimate_us() > 900);
  for (int f = 0; f < 3600; ++f) cost.settle();  // a minute
  CHECK(cost.change.estimate_us() < 50);
}
