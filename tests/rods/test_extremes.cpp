// test_extremes.cpp  The ends of every range: bounded, finite, recovered.
#include <catch2/catch.hpp>

#include "tests/pack/count_allocations.hpp"
#include "tests/rods/rod_scenes.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr double kHeld = 1e-3;  // stretch that is left where iterations end at their cap

// Falls for a while; the number of strands that had to be put back.
uint32_t fall(test::RodBatch& batch, const test::Segments& segments, int steps, float dt_s) {
  uint32_t recovered = 0;
  for (int i = 0; i < steps; ++i) recovered += test::step(batch, dt_s).recovered;
  CHECK(test::largest_stretch(batch, segments) < kHeld);
  return recovered;
}

rods::SegmentStart off_by_a_fifth(rods::SegmentStart start, std::mt19937* random) {
  for (float* three :
       {start.acceleration_m_s2, start.angular_acceleration_rad_s2, start.force_n, start.moment_nm}) {
    for (int k = 0; k < 3; ++k) three[k] *= test::uniform(*random, 0.8f, 1.2f);
  }
  return start;
}

}  // namespace

TEST_CASE("rods_of_two_and_of_two_thousand_segments_fall") {
  for (const uint32_t count : {2u, 2000u}) {
    for (const float young : {1e4f, 1e9f}) {
      const test::Segments rod = test::straight_rod({.segments = count, .young_pa = young});
      test::RodBatch batch = test::batch_of({rod});
      INFO(count << " segments, E " << young);
      CHECK(fall(batch, rod, 100, 0.02f) == 0);
    }
  }
}

TEST_CASE("rods_of_a_millimetre_and_of_a_hundred_metres_fall") {
  for (const double length : {1e-3, 1.0, 100.0}) {
    for (const float young : {1e2f, 1e6f, 1e12f}) {
      const test::Segments rod = test::straight_rod({.segments = 40,
                                                     .young_pa = young,
                                                     .length_m = length,
                                                     .radius_m = static_cast<float>(length / 400)});
      test::RodBatch batch = test::batch_of({rod});
      INFO(length << " m, E " << young);
      CHECK(fall(batch, rod, 100, 0.02f) == 0);
      // What hangs cannot be further away than it is long.
      CHECK(test::distance(test::end_of(batch, rod, 39), test::end_of(batch, rod, 0)) < length * 1.001);
    }
  }
}

TEST_CASE("masses_of_one_to_a_million_fall_either_way_round") {
  for (const bool heavy_tip : {true, false}) {
    test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e6f});
    rod[heavy_tip ? 19 : 1].density_kg_m3 = 1e9f;
    test::RodBatch batch = test::batch_of({rod});
    INFO((heavy_tip ? "heavy tip" : "heavy root"));
    CHECK(fall(batch, rod, 200, 0.01f) == 0);
  }
}

TEST_CASE("rods_fall_without_gaining_energy_at_every_stiffness_and_step_at_default_settings") {
  for (const float dt : {0.001f, 0.02f, 0.1f}) {
    for (float young = 1e2f; young < 2e12f; young *= 100) {
      const test::Segments rod =
          test::straight_rod({.segments = 30, .young_pa = young, .torsion_pa = young / 3});
      test::RodBatch batch = test::batch_of({rod});
      const double fall = 30 * rods::segment_inertia(rod[0]).mass_kg * 9.81 * 2;  // what gravity can give
      const double began = test::energy(batch, rod, 9.81).sum_j();
      double last = began, grown = 0, highest = -HUGE_VAL;
      uint32_t unconverged = 0;
      for (int i = 0; i < 300; ++i) {
        unconverged += test::step(batch, dt).unconverged;
        const double now = test::energy(batch, rod, 9.81).sum_j();
        grown = std::max(grown, now - last);
        highest = std::max(highest, now);
        last = now;
      }
      INFO("E " << young << ", dt " << dt);
      CHECK(unconverged == 0);
      CHECK(highest < began);  // the step itself takes energy, most where it is longest
      // What grows in a step is what the tolerance leaves undone of it, where little moves any more.
      CHECK(grown < 1e-5 * fall);
      CHECK(test::largest_stretch(batch, rod) < kHeld);
    }
  }
}

TEST_CASE("masses_of_one_to_a_million_hold_at_the_longest_and_the_shortest_step") {
  for (const bool heavy_tip : {true, false}) {
    for (const float dt : {0.001f, 0.1f}) {
      for (const float young : {1e4f, 1e9f}) {
        test::Segments rod = test::straight_rod({.segments = 20, .young_pa = young});
        rod[heavy_tip ? 19 : 1].density_kg_m3 = 1e9f;
        test::RodBatch batch = test::batch_of({rod});
        INFO((heavy_tip ? "heavy tip" : "heavy root") << ", E " << young << ", dt " << dt);
        CHECK(fall(batch, rod, 200, dt) == 0);
      }
    }
  }
}

TEST_CASE("a_root_that_flies_a_kilometre_within_a_step_is_followed_or_joined_and_comes_to_rest") {
  for (const float young : {1e4f, 1e9f}) {
    const test::Segments rod = test::straight_rod({.segments = 30, .young_pa = young});
    test::RodBatch batch = test::batch_of({rod}, {.teleport_lengths = 1e6f});  // not carried: 50 km/s
    rods::SegmentPose target = batch.pose(0, 0);
    target.position_m[2] += 1000;
    REQUIRE(batch.set_target(0, 0, target).ok());
    const double there[3] = {target.position_m[0], target.position_m[1], target.position_m[2]};
    uint32_t recovered = 0;
    for (int i = 0; i < 2000; ++i) {
      recovered += test::step(batch, 0.02f).recovered;
      // Torn by less than half a segment at each joint.
      REQUIRE(test::distance(batch.pose(0, 29).position_m, there) < 1.5 * 4);
    }
    INFO("E " << young);
    CHECK(recovered == 0);
    CHECK(test::largest_stretch(batch, rod) < kHeld);
    const double fallen = 30 * rods::segment_inertia(rod[0]).mass_kg * 9.81 * 4;
    CHECK(test::energy(batch, rod, 9.81).kinetic_j < fallen);
  }
}

TEST_CASE("whatever_is_left_undone_a_rod_stays_within_reach_of_where_it_is_held") {
  for (const uint32_t count : {30u, 200u}) {
    for (const float young : {1e4f, 1e9f}) {
      const test::Segments rod = test::straight_rod({.segments = count, .young_pa = young});
      test::RodBatch batch = test::batch_of({rod}, {.max_iterations = 1});
      for (int i = 0; i < 200; ++i) REQUIRE(test::step(batch, 0.02f).recovered == 0);
      INFO(count << " segments, E " << young);
      const rods::SegmentPose root = batch.pose(0, 0);
      CHECK(test::distance(batch.pose(0, count - 1).position_m, root.position_m) < 1.5 * 4);
    }
  }
}

TEST_CASE("lengths_hold_over_ten_thousand_steps_from_the_last_forces_and_from_guesses_off_by_a_fifth") {
  for (const float young : {1e4f, 1e6f, 1e9f}) {
    const test::Segments rod = test::straight_rod({.segments = 12, .young_pa = young});
    for (const rods::RodStart start : {rods::RodStart::kPrevious, rods::RodStart::kGiven}) {
      test::RodBatch batch = test::batch_of({rod}, {.start = start});
      std::mt19937 random(3);
      double longest = 0;
      for (int i = 0; i < 10000; ++i) {
        for (uint32_t k = 1; start == rods::RodStart::kGiven && k < 12; ++k) {
          REQUIRE(batch.set_start(0, k, off_by_a_fifth(batch.last_forces(0, k), &random)).ok());
        }
        test::step(batch, 0.02f);
        if (i % 10 == 0) longest = std::max(longest, test::length_ratio(batch, rod));
      }
      INFO("E " << young << ", start " << static_cast<int>(start));
      CHECK(longest < 1.0001);
    }
  }
}

TEST_CASE("a_root_that_jumps_within_a_step_pulls_its_rod_along") {
  const test::Segments rod = test::straight_rod({.segments = 30, .young_pa = 1e5f});
  test::RodBatch batch = test::batch_of({rod});
  for (int i = 0; i < 50; ++i) {
    rods::SegmentPose target = batch.pose(0, 0);
    target.position_m[2] += i % 2 ? -2.0 : 2.0;  // half its length, at 100 m/s
    REQUIRE(batch.set_target(0, 0, target).ok());
    CHECK(test::step(batch, 0.02f).recovered == 0);
  }
  CHECK(fall(batch, rod, 100, 0.02f) == 0);
}

TEST_CASE("a_rod_thrown_with_impossible_speed_comes_to_its_senses") {
  const test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e6f});
  test::RodBatch batch = test::batch_of({rod});
  for (uint32_t i = 1; i < 20; ++i) {
    REQUIRE(batch.set_velocity(0, i, {{0, 1e4f, i % 2 ? 1e4f : -1e4f}, {1e4f, 0, 1e4f}}).ok());
  }
  fall(batch, rod, 200, 0.02f);
  const double fallen = 20 * rods::segment_inertia(rod[0]).mass_kg * 9.81 * 4;
  for (int i = 0; i < 2000; ++i) test::step(batch, 0.02f);
  CHECK(test::energy(batch, rod, 9.81).kinetic_j < fallen);
}

TEST_CASE("a_rod_held_twice_too_far_apart_stays_finite_and_comes_back") {
  test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e6f});
  rod.back().fixed = true;
  test::RodBatch batch = test::batch_of({rod});
  rods::SegmentPose target = batch.pose(0, 19), back = target;
  target.position_m[0] += 0.5;  // the rod is 4 m long and does not stretch
  REQUIRE(batch.set_target(0, 19, target).ok());
  for (int i = 0; i < 50; ++i) test::step(batch, 0.02f);
  back.position_m[0] -= 0.1;
  REQUIRE(batch.set_target(0, 19, back).ok());
  for (int i = 0; i < 200; ++i) test::step(batch, 0.02f);
  CHECK(test::largest_stretch(batch, rod) < kHeld);
}

TEST_CASE("a_rod_held_out_of_reach_for_long_keeps_no_force_and_is_not_torn_when_let_go") {
  test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e6f});
  rod.back().fixed = true;
  test::RodBatch batch = test::batch_of({rod});
  rods::SegmentPose target = batch.pose(0, 19);
  target.position_m[0] += 0.03;  // a sixth of a segment: too far, but nothing tears
  REQUIRE(batch.set_target(0, 19, target).ok());
  for (int i = 0; i < 500; ++i) {
    const test::RodReport report = test::step(batch, 0.02f);
    CHECK(report.unconverged == 1);
    CHECK(report.rejoined == 0);
  }
  for (uint32_t i = 0; i < 20; ++i) {
    for (const float f : batch.last_forces(0, i).force_n) CHECK(f == 0);
  }
  target.position_m[0] -= 0.15;
  REQUIRE(batch.set_target(0, 19, target).ok());
  for (int i = 0; i < 200; ++i) CHECK(test::step(batch, 0.02f).rejoined == 0);
  CHECK(test::largest_stretch(batch, rod) < kHeld);
}

TEST_CASE("a_step_allocates_nothing") {
  test::RodBatch batch = test::batch_of(std::vector<test::Segments>(20, test::helix(16)));
  test::step(batch, 0.02f);
  const size_t before = test::allocation_count();
  for (int i = 0; i < 10; ++i) test::step(batch, 0.02f);
  CHECK(test::allocation_count() == before);
}
