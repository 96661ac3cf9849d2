// test_cost_model.cpp  Estimates follow the clock, and one preempted measurement does not throw them.
#include <catch2/catch.hpp>
#include <limits>

#include "frame/cost_model.hpp"

using sinew::frame::Capacity;
using sinew::frame::CostEstimate;

TEST_CASE("cost_estimate_ignores_samples_that_are_no_times") {
  CostEstimate cost(10);
  cost.observe(std::numeric_limits<float>::quiet_NaN());
  cost.observe(std::numeric_limits<float>::infinity());
  cost.observe(-1);
  CHECK(cost.estimate_us() == 10);
}

TEST_CASE("cost_estimate_reaches_the_measured_cost_in_a_second_of_frames") {
  CostEstimate cost(10);
  for (int f = 0; f < 60; ++f) cost.observe(35);
  CHECK(cost.estimate_us() == Approx(35).epsilon(0.02));
  for (int f = 0; f < 60; ++f) cost.observe(3);
  CHECK(cost.estimate_us() == Approx(3).epsilon(0.02));
}

TEST_CASE("one_preempted_sample_moves_the_estimate_by_an_eighth_at_most") {
  CostEstimate cost(10);
  cost.observe(1e6f);
  CHECK(cost.estimate_us() <= 10 * (1 + 1.0f / 8) + 1e-4f);
}

TEST_CASE("cost_estimate_starts_from_the_first_sample_where_nothing_was_baked") {
  CostEstimate cost;
  cost.observe(7);
  CHECK(cost.estimate_us() == 7);
}

TEST_CASE("unmeasured_estimate_drifts_back_to_the_baked_cost") {
  CostEstimate cost(10);
  for (int f = 0; f < 60; ++f) cost.observe(1000);
  const float high = cost.estimate_us();
  REQUIRE(high > 900);
  cost.observe(high);
  cost.relax();
  CHECK(cost.estimate_us() == high);  // measured in this step: no drift
  for (int f = 0; f < 600; ++f) cost.relax();
  CHECK(cost.estimate_us() < 20);
}

TEST_CASE("capacity_grows_while_threads_leave_time_and_shrinks_when_over") {
  Capacity capacity;
  for (int f = 0; f < 100; ++f) capacity.observe(300, 1000, true);
  const float grown = capacity.scale();
  CHECK(grown > 2);
  capacity.observe(1100, 1000, true);
  CHECK(capacity.scale() < grown);
  for (int f = 0; f < 1000; ++f) capacity.observe(1e6f, 1000, true);
  CHECK(capacity.scale() == 0.25f);
}

TEST_CASE("capacity_stays_where_nothing_was_denied") {
  Capacity capacity;
  for (int f = 0; f < 100; ++f) capacity.observe(300, 1000, false);
  CHECK(capacity.scale() == 1);
}
