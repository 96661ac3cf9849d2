// test_recover_strand.cpp  A strand that is lost comes back; its neighbours do not notice.
#include <catch2/catch.hpp>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

// Two finite numbers whose product is not: only such can make a strand infinite from outside.
void spoil(test::RodBatch& batch, uint32_t strand) {
  REQUIRE(batch.set_velocity(strand, 3, {{3e38f, 0, 0}, {3e38f, 3e38f, 0}}).ok());
}

}  // namespace

TEST_CASE("a_strand_that_is_not_finite_is_put_back_at_rest_where_it_is_held_and_counted") {
  const test::Segments segments = test::helix(12);
  test::RodBatch batch = test::batch_of(std::vector<test::Segments>(6, segments));
  test::RodBatch untouched = test::batch_of(std::vector<test::Segments>(6, segments));
  rods::SegmentPose target = batch.pose(2, 0);
  target.position_m[1] += 0.05;
  REQUIRE(batch.set_target(2, 0, target).ok());
  REQUIRE(untouched.set_target(2, 0, target).ok());
  spoil(batch, 2);
  const test::RodReport report = test::step(batch, 0.02f);
  test::step(untouched, 0.02f);
  CHECK(report.recovered == 1);
  for (uint32_t i = 0; i < 12; ++i) {
    const double expected[3] = {segments[i].position_m[0], segments[i].position_m[1] + 0.05,
                                segments[i].position_m[2]};
    CHECK(test::distance(batch.pose(2, i).position_m, expected) < 1e-6);
    for (const uint32_t other : {0u, 1u, 3u, 4u, 5u}) {
      CHECK(test::distance(batch.pose(other, i).position_m, untouched.pose(other, i).position_m) == 0);
    }
  }
  for (int i = 0; i < 50; ++i) CHECK(test::step(batch, 0.02f).recovered == 0);
  CHECK(test::largest_stretch(batch, segments, 2) < 1e-4);
}

TEST_CASE("a_free_strand_that_is_lost_returns_to_where_it_was_made") {
  test::Segments segments = test::helix(5);
  segments[0].fixed = false;
  test::RodBatch batch = test::batch_of({segments});
  spoil(batch, 0);
  CHECK(test::step(batch, 0.02f).recovered == 1);
  for (uint32_t i = 0; i < 5; ++i) {
    CHECK(test::distance(batch.pose(0, i).position_m, segments[i].position_m) < 1e-8);
  }
}
