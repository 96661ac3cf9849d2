// test_carry_strand.cpp  What jumps goes on as if it had not.
#include <catch2/catch.hpp>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

constexpr uint32_t kSegments = 20;

// A rod without weight that swings.
test::RodBatch swinging(const test::Segments& rod) {
  test::RodBatch batch = test::batch_of({rod}, {.tolerance_rad = 1e-4f, .gravity_m_s2 = {0, 0, 0}});
  for (uint32_t i = 1; i < kSegments; ++i) {
    const float x = 0.1f * static_cast<float>(i);
    REQUIRE(batch.set_velocity(0, i, {{0, x, 0.5f * x}, {0, 0, 0}}).ok());
  }
  for (int i = 0; i < 20; ++i) test::step(batch, 0.02f);
  return batch;
}

}  // namespace

TEST_CASE("a_teleport_that_turns_a_swinging_rod_changes_nothing_of_its_motion") {
  const test::Segments rod = test::straight_rod({.segments = kSegments, .young_pa = 1e5f});
  test::RodBatch stays = swinging(rod), jumps = swinging(rod);
  const rods::SegmentPose root = jumps.pose(0, 0);
  const rods::Turn by = rods::normalised({0.3, -0.8, 0.4, 0.5});
  rods::SegmentPose target = root;
  const rods::Turn q = rods::product(by, rods::turn_of(root.orientation));
  for (size_t k = 0; k < 4; ++k) target.orientation[k] = static_cast<float>(q[k]);
  target.position_m[1] += 1000;  // a kilometre
  REQUIRE(jumps.set_target(0, 0, target).ok());
  for (int i = 0; i < 20; ++i) {
    const test::RodReport a = test::step(stays, 0.02f), b = test::step(jumps, 0.02f);
    CHECK(b.teleported == (i == 0 ? 1 : 0));
    // Forces that had not turned along would cost iterations.
    CHECK(b.iterations == a.iterations);
  }
  for (uint32_t i = 0; i < kSegments; ++i) {
    const rods::SegmentPose p = stays.pose(0, i), now = jumps.pose(0, i);
    const rods::Vector arm =
        rods::turned(by, {p.position_m[0] - root.position_m[0], p.position_m[1] - root.position_m[1],
                          p.position_m[2] - root.position_m[2]});
    const double expected[3] = {target.position_m[0] + arm[0], target.position_m[1] + arm[1],
                                target.position_m[2] + arm[2]};
    CHECK(test::distance(now.position_m, expected) < 1e-4);  // single precision over 20 steps of a 4 m rod
    const rods::Vector f = rods::turned(by, rods::vector_of(stays.last_forces(0, i).force_n)),
                       g = rods::vector_of(jumps.last_forces(0, i).force_n);
    CHECK(test::distance(f, g) < 1e-2 * (0.1 + std::hypot(f[0], f[1], f[2])));
  }
}

TEST_CASE("what_is_held_elsewhere_stays_in_the_world_when_a_strand_is_carried") {
  test::Segments rod = test::helix(12);
  rod[11].fixed = true;
  test::RodBatch batch = test::batch_of({rod});
  const rods::SegmentPose end = batch.pose(0, 11);
  rods::SegmentPose target = batch.pose(0, 0);
  target.position_m[0] += 3;
  REQUIRE(batch.set_target(0, 0, target).ok());
  test::step(batch, 0.02f);
  CHECK(test::distance(batch.pose(0, 11).position_m, end.position_m) < 1e-6);
  CHECK(test::distance(batch.pose(0, 0).position_m, target.position_m) < 1e-9);
}
