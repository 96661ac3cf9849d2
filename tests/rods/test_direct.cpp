// test_direct.cpp  The direct solver against the whole system in double, and lane against lane.
#include <catch2/catch.hpp>
#include <limits>

#include "tests/rods/dense_step.hpp"
#include "tests/rods/recorded_scenes.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr float kDt_s = 0.02f;
// Of a segment's length: single precision over some ten segments, iterated to 1e-6 rad.
constexpr double kDenseError = 2e-5;

test::RodSettings exact(rods::RodStart start = rods::RodStart::kPrevious) {
  return {.start = start, .max_iterations = 200, .tolerance_rad = 3e-6f};
}

// Of the strand's largest: what a joint carries follows from differences of places and turns.
constexpr double kForceError = 2e-3;

// A few steps, each compared with a dense one from the same state.
void check_against_dense(const test::Segments& segments, const test::RodSettings& settings,
                         float dt_s = kDt_s, double error = kDenseError, double force_error = kForceError) {
  test::RodBatch batch = test::batch_of({segments}, settings);
  for (int step = 0; step < 12; ++step) {
    test::DenseRod dense(batch, segments, {0, -9.81f, 0});
    const int iterations = dense.step(static_cast<double>(dt_s));
    REQUIRE(iterations < 200);
    test::step(batch, dt_s);
    const auto off = test::difference(batch, dense, segments, static_cast<double>(dt_s));
    REQUIRE(off.place < error);
    REQUIRE(off.turn < error);
    REQUIRE(off.velocity < error);
    REQUIRE(off.spin < error);
    REQUIRE(off.force < force_error);
    REQUIRE(off.moment < force_error);
  }
}

}  // namespace

TEST_CASE("direct_takes_the_step_that_the_whole_system_in_double_takes") {
  for (const float young : {1e4f, 1e6f, 1e8f}) {
    INFO("Young's modulus " << young);
    check_against_dense(test::straight_rod({.segments = 10, .young_pa = young}), exact());
    check_against_dense(test::helix(8, 0.1, young), exact());
  }
}

TEST_CASE("direct_takes_the_dense_step_where_rods_stretch_are_damped_or_have_heavy_ends") {
  test::Segments rod = test::helix(8, 0.1, 1e6f);
  for (auto& s : rod) {
    s.stretch_modulus_pa = 1e6f;
    s.damping_s = 0.05f;
  }
  check_against_dense(rod, exact());
  rod.back().density_kg_m3 = 1e6f;
  check_against_dense(rod, exact(), kDt_s, 1e-4);  // a thousand times the mass: three digits of six are gone
}

TEST_CASE("direct_takes_the_dense_step_of_trees") {
  for (const float young : {1e5f, 1e8f}) check_against_dense(test::branched_rod(4, 2, young), exact());
}

TEST_CASE("direct_takes_the_dense_step_of_rods_held_at_both_ends_and_in_the_middle") {
  test::Segments rod = test::helix(11, 0.1, 1e5f);
  // A held joint's gap ends at the tolerance; its force, that over the compliance that the matrix is given.
  constexpr double kHeldForce = 0.03;
  rod.back().fixed = true;
  check_against_dense(rod, exact(), kDt_s, kDenseError, kHeldForce);
  rod[5].fixed = true;
  check_against_dense(rod, exact(), kDt_s, kDenseError, kHeldForce);
  rod[6].fixed = true;  // a joint between two that are given
  check_against_dense(rod, exact(), kDt_s, kDenseError, kHeldForce);
}

TEST_CASE("direct_takes_the_dense_step_of_a_rod_that_nothing_holds") {
  test::Segments rod = test::helix(9, 0.1, 1e5f);
  rod[0].fixed = false;
  check_against_dense(rod, exact());
}

TEST_CASE("a_tree_without_branches_is_a_chain_to_the_bit_whatever_its_order_of_listing") {
  // Two branches at the root, listed one after the other and in turns: the same rods, the same numbers.
  const test::Segments arm = test::straight_rod({.segments = 6});
  test::Segments one = arm, other = arm;
  for (uint32_t i = 1; i < 6; ++i) {  // 6..10 repeat 1..5
    test::SegmentDef s = arm[i];
    s.parent = i == 1 ? 0 : 4 + i;
    one.push_back(s);
  }
  other.resize(1);
  for (uint32_t i = 1; i < 6; ++i) {
    for (uint32_t twin = 0; twin < 2; ++twin) {
      test::SegmentDef s = arm[i];
      s.parent = i == 1 ? 0 : static_cast<uint32_t>(other.size()) - 2;
      other.push_back(s);
    }
  }
  test::RodBatch chain = test::batch_of({arm}), a = test::batch_of({one}), b = test::batch_of({other});
  for (int step = 0; step < 40; ++step) {
    for (test::RodBatch* batch : {&chain, &a, &b}) test::step(*batch, kDt_s);
    for (uint32_t i = 1; i < 6; ++i) {
      const auto expected = chain.pose(0, i);
      CHECK(test::distance(a.pose(0, i).position_m, expected.position_m) == 0);
      CHECK(test::distance(a.pose(0, i + 5).position_m, expected.position_m) == 0);
      CHECK(test::distance(b.pose(0, 2 * i - 1).position_m, expected.position_m) == 0);
      CHECK(test::distance(b.pose(0, 2 * i).position_m, expected.position_m) == 0);
    }
  }
}

TEST_CASE("the_converged_step_does_not_depend_on_the_start") {
  for (const float young : {1e4f, 1e6f, 1e8f}) {
    const test::Segments segments = test::straight_rod({.segments = 30, .young_pa = young});
    test::RodBatch batch = test::batch_of({segments}, exact(rods::RodStart::kGiven));
    test::RodBatch zero = test::batch_of({segments}, exact(rods::RodStart::kZero));
    std::mt19937 random(5);
    double guess_error = 0;
    for (int step = 0; step < 25; ++step) {
      // The answer of a twin in the same state, each number off by up to a fifth either way.
      test::RodBatch twin = test::batch_of({segments}, exact(rods::RodStart::kZero));
      for (int t = 0; t <= step; ++t) test::step(twin, kDt_s);
      for (uint32_t i = 0; i < 30; ++i) {
        rods::SegmentStart start = twin.last_forces(0, i);
        for (int k = 0; k < 3; ++k) {
          const auto off = [&] { return test::uniform(random, 0.8f, 1.2f); };
          const float exact_push = start.acceleration_m_s2[k];
          start.acceleration_m_s2[k] *= off();
          start.angular_acceleration_rad_s2[k] *= off();
          start.force_n[k] *= off();
          start.moment_nm[k] *= off();
          guess_error = std::max(
              guess_error,
              static_cast<double>(std::fabs(start.acceleration_m_s2[k] - exact_push) * kDt_s * kDt_s));
        }
        REQUIRE(batch.set_start(0, i, start).ok());
      }
      test::step(batch, kDt_s);
      test::step(zero, kDt_s);
    }
    double largest = 0;
    for (uint32_t i = 0; i < 30; ++i) {
      largest = std::max(largest, test::distance(batch.pose(0, i).position_m, zero.pose(0, i).position_m));
    }
    INFO("E " << young << ": the guesses were off by up to " << guess_error << " m, the answers differ by "
              << largest);
    CHECK(guess_error > 4e-4);
    CHECK(largest < 1e-5);  // 25 steps of single precision; the trap would leave the guesses' own error
  }
}

TEST_CASE("a_strand_does_not_know_of_its_neighbours") {
  const test::Segments soft = test::straight_rod({.segments = 12, .young_pa = 1e3f});
  const test::Segments stiff = test::straight_rod({.segments = 12, .young_pa = 1e9f});
  for (const size_t count : {2u, 4u, 5u, 16u, 17u, 33u}) {
    std::vector<test::Segments> strands(count, stiff);
    strands[count - 1] = soft;
    test::RodBatch batch = test::batch_of(strands), alone = test::batch_of({soft});
    test::RodBatch quiet = test::batch_of({stiff});
    for (int step = 0; step < 40; ++step) {
      for (test::RodBatch* b : {&batch, &alone, &quiet}) test::step(*b, kDt_s);
    }
    for (uint32_t i = 0; i < 12; ++i) {
      const auto last = static_cast<uint32_t>(count - 1);
      CHECK(test::distance(batch.pose(last, i).position_m, alone.pose(0, i).position_m) == 0);
      for (uint32_t s = 0; s < last; ++s) {
        CHECK(test::distance(batch.pose(s, i).position_m, quiet.pose(0, i).position_m) == 0);
      }
    }
  }
}

TEST_CASE("rods_have_the_same_bits_on_all_targets_with_fma_in_narrow_groups_and_wide") {
  test::require_same_bits_where_fused(0x5e49146f7a0296a9, [](const simd::Kernels&) {
    std::vector<float> out;
    test::append_bent({}, &out);
    return out;
  });
}

TEST_CASE("rods_fall_alike_on_every_target") {
  // Without fused products a swing of 20 steps differs by some hundred roundings.
  constexpr double kRounding = 1e-4;
  const test::Segments segments = test::helix(9, 0.1, 1e6f);
  std::vector<rods::SegmentPose> first;
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    test::RodBatch batch = test::batch_of({segments});
    for (int step = 0; step < 20; ++step) test::step(batch, kDt_s);
    for (uint32_t i = 0; i < 9; ++i) {
      if (first.size() < 9) first.push_back(batch.pose(0, i));
      CHECK(test::distance(batch.pose(0, i).position_m, first[i].position_m) < kRounding);
    }
  });
}
