// test_rod_batch.cpp  What goes into a batch and comes out of it.
#include "rods/rod_batch.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void refused(const Status& status, const std::string& expected) {
  INFO(expected << " | " << status.message);
  CHECK_FALSE(status.ok());
  CHECK(std::string(status.message).find(expected) != std::string::npos);
}

}  // namespace

TEST_CASE("bad_poses_forces_velocities_starts_and_times_are_refused_and_change_nothing") {
  const test::Segments hair = test::straight_rod({.segments = 4, .length_m = 0.4, .radius_m = 1e-6f});
  test::RodBatch batch = test::batch_of({hair}, {.start = rods::RodStart::kGiven});
  test::RodBatch same = test::batch_of({hair}, {.start = rods::RodStart::kGiven});
  const rods::SegmentPose good = batch.pose(0, 0);
  rods::SegmentPose bad = good;
  bad.position_m[1] = std::nan("");
  refused(batch.set_target(0, 0, bad), "strand 0, segment 0: the pose is not finite");
  bad = good;
  bad.orientation[2] = kNan;
  refused(batch.set_target(0, 0, bad), "strand 0, segment 0: the pose is not finite");
  bad = good;
  bad.orientation[3] = 2;
  refused(batch.set_target(0, 0, bad), "give a unit quaternion");
  refused(batch.set_target(0, 2, good), "strand 0, segment 2: its pose is simulated");
  refused(batch.set_target(1, 0, good), "strand 1, segment 0: the batch has 1 strands of 4 segments");
  refused(batch.set_target(0, 4, good), "strand 0, segment 4: the batch has");
  refused(batch.set_force(0, 1, {0, kNan, 0}), "strand 0, segment 1: force_n is not finite");
  refused(batch.set_force(9, 1, {0, 0, 0}), "strand 9");
  refused(batch.set_velocity(0, 1, {{kNan, 0, 0}, {0, 0, 0}}), "the velocity is not finite");
  refused(batch.set_velocity(0, 9, {}), "segment 9");
  bad = good;
  bad.position_m[0] = 1e300;
  refused(batch.set_target(0, 0, bad), "strand 0, segment 0: the position, over");
  // Finite, but over a segment's tenth of a metre and third of a billionth of a kilogram they are not.
  refused(batch.set_force(0, 1, {0, 1e30f, 0}), "strand 0, segment 1: force_n, over");
  refused(batch.set_velocity(0, 1, {{0, 3e38f, 0}, {0, 0, 0}}), "strand 0, segment 1: the velocity, over");
  test::RodBatch askew = test::batch_of({test::helix(3)});
  refused(askew.set_velocity(0, 2, {{0, 0, 0}, {3e38f, 3e38f, 3e38f}}), "the velocity, over");
  refused(batch.set_start(0, 1, {.force_n = {0, 0, HUGE_VALF}}), "the start is not finite");
  refused(batch.set_start(0, 1, {.force_n = {0, 0, 1e30f}}), "strand 0, segment 1: the start, over");
  refused(batch.set_start(0, 1, {.acceleration_m_s2 = {3e38f, 0, 0}}), "the start, over");
  refused(batch.set_start(0, 1, {.moment_nm = {0, 0, 1e30f}}), "the start, over");
  refused(batch.set_start(0, 9, {}), "segment 9");
  refused(batch.set_force(0, 0, {0, 1, 0}), "strand 0, segment 0: it is fixed and force_n would do nothing");
  refused(batch.set_velocity(0, 0, {}), "strand 0, segment 0: it is fixed and the velocity would do nothing");
  for (const float dt : {0.0f, -0.01f, 1.5f, kNan}) refused(batch.step(dt, nullptr), "dt_s is");
  test::step(batch, 0.02f);
  test::step(same, 0.02f);
  for (uint32_t i = 0; i < 4; ++i) {
    CHECK(test::distance(batch.pose(0, i).position_m, same.pose(0, i).position_m) == 0);
  }
}

TEST_CASE("a_start_is_refused_by_a_batch_that_does_not_read_it") {
  for (const rods::RodStart start : {rods::RodStart::kZero, rods::RodStart::kPrevious}) {
    test::RodBatch batch = test::batch_of({test::straight_rod({.segments = 4})}, {.start = start});
    refused(batch.set_start(0, 1, {}), "strand 0, segment 1: this batch reads no start");
  }
}

TEST_CASE("velocities_come_out_as_they_went_in") {
  test::RodBatch batch = test::batch_of({test::helix(3)});
  const rods::SegmentVelocity v = {{1, -2, 3}, {4, 5, -6}};
  REQUIRE(batch.set_velocity(0, 2, v).ok());
  const rods::SegmentVelocity out = batch.velocity(0, 2);
  for (int k = 0; k < 3; ++k) {
    CHECK(out.linear_m_s[k] == Approx(v.linear_m_s[k]).epsilon(1e-5));
    CHECK(out.angular_rad_s[k] == Approx(v.angular_rad_s[k]).epsilon(1e-5));
  }
}

TEST_CASE("a_fixed_segment_is_where_its_target_says_and_has_the_velocity_that_took_it_there") {
  test::RodBatch batch = test::batch_of({test::straight_rod({.segments = 4})});
  rods::SegmentPose target = batch.pose(0, 0);
  target.position_m[2] += 0.03;
  const double half = 0.05;  // of the turn about the world's y
  const rods::Turn q =
      rods::product({0, std::sin(half), 0, std::cos(half)}, rods::turn_of(target.orientation));
  for (size_t k = 0; k < 4; ++k) target.orientation[k] = static_cast<float>(q[k]);
  REQUIRE(batch.set_target(0, 0, target).ok());
  test::step(batch, 0.01f);
  CHECK(test::distance(batch.pose(0, 0).position_m, target.position_m) < 1e-8);
  CHECK(batch.velocity(0, 0).linear_m_s[2] == Approx(3).epsilon(1e-5));
  // A chord for its arc: off by (angle / 2)^2 / 6.
  CHECK(batch.velocity(0, 0).angular_rad_s[1] == Approx(10).epsilon(1e-3));
  const rods::SegmentPose held = batch.pose(0, 0);
  test::step(batch, 0.01f);
  CHECK(test::distance(batch.pose(0, 0).position_m, held.position_m) == 0);
  CHECK(batch.velocity(0, 0).linear_m_s[2] == 0);
}

TEST_CASE("a_teleport_carries_the_strand_along_as_it_is") {
  const test::Segments segments = test::straight_rod({.segments = 20});
  test::RodBatch batch = test::batch_of({segments});
  for (int i = 0; i < 30; ++i) test::step(batch, 0.02f);
  std::vector<rods::SegmentPose> before;
  for (uint32_t i = 0; i < 20; ++i) before.push_back(batch.pose(0, i));
  rods::SegmentPose target = batch.pose(0, 0);
  target.position_m[0] += 1000;
  REQUIRE(batch.set_target(0, 0, target).ok());
  const test::RodReport report = test::step(batch, 0.001f);
  CHECK(report.teleported == 1);
  for (uint32_t i = 0; i < 20; ++i) {
    const double gone[3] = {before[i].position_m[0] + 1000, before[i].position_m[1], before[i].position_m[2]};
    CHECK(test::distance(batch.pose(0, i).position_m, gone) < 0.02);  // a millisecond at less than 20 m/s
  }
  CHECK(test::largest_stretch(batch, segments) < 1e-4);
  CHECK(test::step(batch, 0.001f).teleported == 0);
}
