// test_recover_strand.cpp  A strand that is lost comes back; its neighbours do not notice.
#include <catch2/catch.hpp>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

// A step in which a strand is lost: velocity and force are finite in the strand's own units, too; what a step
// makes of both is not.
test::RodReport lose(test::RodBatch& batch, uint32_t strand) {
  REQUIRE(batch.set_velocity(strand, 3, {{6.7e36f, 0, 0}, {0, 0, 0}}).ok());
  REQUIRE(batch.set_force(strand, 3, {1.6e33f, 0, 0}).ok());
  const test::RodReport report = test::step(batch, 0.02f);
  REQUIRE(batch.set_force(strand, 3, {0, 0, 0}).ok());
  return report;
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
  const test::RodReport report = lose(batch, 2);
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
  CHECK(lose(batch, 0).recovered == 1);
  for (uint32_t i = 0; i < 5; ++i) {
    // Two floats a number: some 1e-14 of the strand's length.
    CHECK(test::distance(batch.pose(0, i).position_m, segments[i].position_m) < 1e-12);
  }
}

TEST_CASE("every_segment_whose_pose_is_given_stays_where_it_is_when_its_strand_is_lost") {
  test::Segments segments = test::helix(12);
  segments[8].fixed = true;
  test::RodBatch batch = test::batch_of({segments});
  rods::SegmentPose targets[2] = {batch.pose(0, 0), batch.pose(0, 8)};
  targets[0].position_m[1] += 0.05;
  targets[1].position_m[0] += 0.02;
  const rods::Turn q = rods::product(rods::normalised({0, 0.1, 0, 1}), rods::turn_of(targets[1].orientation));
  for (size_t k = 0; k < 4; ++k) targets[1].orientation[k] = static_cast<float>(q[k]);
  REQUIRE(batch.set_target(0, 0, targets[0]).ok());
  REQUIRE(batch.set_target(0, 8, targets[1]).ok());
  CHECK(lose(batch, 0).recovered == 1);
  const auto at_its_target = [&](uint32_t segment, const rods::SegmentPose& target) {
    const rods::SegmentPose pose = batch.pose(0, segment);
    CHECK(test::distance(pose.position_m, target.position_m) < 1e-8);  // a target is one float
    for (int k = 0; k < 4; ++k) CHECK(std::fabs(pose.orientation[k] - target.orientation[k]) < 1e-6f);
  };
  for (int i = 0; i < 2; ++i) {  // and in the next step, without a target
    at_its_target(0, targets[0]);
    at_its_target(8, targets[1]);
    CHECK(test::step(batch, 0.02f).recovered == 0);
  }
}

TEST_CASE("a_strand_that_is_lost_far_from_where_it_was_made_is_put_back_as_exactly_as_near") {
  const test::Segments segments = test::helix(12);
  test::RodBatch batch = test::batch_of({segments});
  rods::SegmentPose target = batch.pose(0, 0);
  target.position_m[0] += 1000.003;
  REQUIRE(batch.set_target(0, 0, target).ok());
  CHECK(lose(batch, 0).recovered == 1);
  for (uint32_t i = 0; i < 12; ++i) {
    const double expected[3] = {segments[i].position_m[0] + 1000.003, segments[i].position_m[1],
                                segments[i].position_m[2]};
    // One float rounds by 40 um there. Orientations of single precision: 1e-7 of 0.2 m.
    CHECK(test::distance(batch.pose(0, i).position_m, expected) < 1e-7);
  }
}
