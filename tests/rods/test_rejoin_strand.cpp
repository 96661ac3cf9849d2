// test_rejoin_strand.cpp  A torn strand is put together outwards from what is held.
#include <catch2/catch.hpp>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

constexpr double kJoined = 1e-6;  // gap over a segment: orientations of single precision

// Segments `held` of a straight rod of 20 are fixed; the rest is thrown apart within a step of one iteration.
test::RodBatch torn(const std::vector<uint32_t>& held, test::Segments* rod) {
  *rod = test::straight_rod({.segments = 20, .held = false});
  for (const uint32_t i : held) (*rod)[i].fixed = true;
  test::RodBatch batch = test::batch_of({*rod}, {.max_iterations = 1});
  for (uint32_t i = 0; i < 20; ++i) {
    if ((*rod)[i].fixed) continue;
    const float aside = i % 2 ? 300.0f : -300.0f;
    REQUIRE(batch.set_velocity(0, i, {{0, 0, aside}, {100, 200, 0}}).ok());
  }
  const test::RodReport report = test::step(batch, 0.02f);
  CHECK(report.rejoined == 1);
  return batch;
}

double gap_at(const test::RodBatch& batch, const test::Segments& rod, uint32_t segment) {
  const test::Segments pair = {rod[segment - 1], rod[segment]};
  rods::Constraint c;
  const double length = static_cast<double>(rod[segment].length_m);
  if (!rods::stretch_shear(test::joint_end(batch.pose(0, segment - 1), length),
                           test::joint_end(batch.pose(0, segment), length), &c)) {
    return HUGE_VAL;
  }
  return std::hypot(c.value[0], c.value[1], c.value[2]) / length;
}

}  // namespace

TEST_CASE("a_torn_strand_is_joined_outwards_from_wherever_it_is_held") {
  for (const uint32_t held : {0u, 7u, 19u}) {
    test::Segments rod;
    const test::RodBatch batch = torn({held}, &rod);
    INFO("held at segment " << held);
    CHECK(test::largest_stretch(batch, rod) < kJoined);
    CHECK(test::distance(batch.pose(0, held).position_m, rod[held].position_m) < 1e-9);
  }
}

TEST_CASE("a_torn_strand_that_is_held_twice_keeps_its_gap_halfway") {
  test::Segments rod;
  const test::RodBatch batch = torn({3, 14}, &rod);
  for (uint32_t i = 1; i < 20; ++i) {
    INFO("joint of segment " << i);
    if (i == 9) continue;  // six segments from one, six from the other
    CHECK(gap_at(batch, rod, i) < kJoined);
  }
  for (const uint32_t held : {3u, 14u}) {
    CHECK(test::distance(batch.pose(0, held).position_m, rod[held].position_m) < 1e-9);
  }
}

TEST_CASE("a_torn_strand_that_nothing_holds_is_joined_from_its_root") {
  test::Segments rod;
  const test::RodBatch batch = torn({}, &rod);
  CHECK(test::largest_stretch(batch, rod) < kJoined);
}
