// test_statics.cpp  Rods at rest against beam theory.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

constexpr uint32_t kSegments = 64;
// The aim. A joint every l carries its segment's curvature as the midpoint rule does: off by (l/L)^2
// / 4, 6e-5; the deflections below bend so little that theory's small angles are off by 1e-5.
constexpr double kTheory = 1e-3;

// Fully damped, so that a long step is a step to rest.
test::Segments quiet_rod(float young_pa, float torsion_pa) {
  test::Segments rod = test::straight_rod({.segments = kSegments,
                                           .young_pa = young_pa,
                                           .length_m = 1,
                                           .radius_m = 0.01f,
                                           .torsion_pa = torsion_pa});
  for (auto& s : rod) s.damping_s = 0.02f;
  return rod;
}

void settle(test::RodBatch& batch) {
  for (int i = 0; i < 400; ++i) test::step(batch, 0.1f);
}

double second_moment() { return std::numbers::pi * std::pow(0.01, 4) / 4; }

// The rod is held in the middle of its first segment and free from there on.
double free_length(const test::Segments& rod) { return 1 - 0.5 * static_cast<double>(rod[0].length_m); }

}  // namespace

TEST_CASE("a_cantilever_bends_by_its_load_at_the_tip_as_theory_says") {
  const test::Segments rod = quiet_rod(1e9f, 1e9f);
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  REQUIRE(batch.set_force(0, kSegments - 1, {0, -0.05f, 0}).ok());
  settle(batch);
  const double arm =
      free_length(rod) - 0.5 * static_cast<double>(rod[0].length_m);  // the load sits in a middle
  const double expected = 0.05 * std::pow(arm, 3) / (3 * 1e9 * second_moment());
  CHECK(-batch.pose(0, kSegments - 1).position_m[1] == Approx(expected).epsilon(kTheory));
}

TEST_CASE("a_cantilever_bends_by_its_own_weight_as_theory_says") {
  const test::Segments rod = quiet_rod(2e9f, 2e9f);
  test::RodBatch batch = test::batch_of({rod});
  settle(batch);
  const double weight = 1000 * std::numbers::pi * 1e-4 * 9.81;  // N/m
  const double expected = weight * std::pow(free_length(rod), 4) / (8 * 2e9 * second_moment());
  CHECK(-test::end_of(batch, rod, kSegments - 1)[1] == Approx(expected).epsilon(kTheory));
}

TEST_CASE("a_rod_twists_by_a_turn_of_its_end_as_evenly_as_theory_says") {
  test::Segments rod = quiet_rod(1e8f, 1e7f);
  rod.back().fixed = true;
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  rods::SegmentPose target = batch.pose(0, kSegments - 1);
  const double angle = 0.6;
  const rods::Turn q =
      rods::product({std::sin(angle / 2), 0, 0, std::cos(angle / 2)}, rods::turn_of(target.orientation));
  for (size_t k = 0; k < 4; ++k) target.orientation[k] = static_cast<float>(q[k]);
  REQUIRE(batch.set_target(0, kSegments - 1, target).ok());
  settle(batch);
  const auto roll = [&](uint32_t i) {  // of own y about the world's x
    const rods::Vector y = rods::turned(rods::turn_of(batch.pose(0, i).orientation), {0, 1, 0});
    return std::atan2(y[2], y[1]);
  };
  for (const uint32_t i : {16u, 32u, 48u}) {
    CHECK(roll(i) == Approx(angle * i / (kSegments - 1)).epsilon(kTheory));
  }
  const double l = 63.0 / 64, moment = 1e7 * 2 * second_moment() * angle / l;
  // The moment is minus the derivative of the energy: what turns the joint back.
  CHECK(batch.last_forces(0, 32).moment_nm[2] == Approx(-moment).epsilon(kTheory));
}

TEST_CASE("a_rod_that_stretches_hangs_as_long_as_theory_says") {
  test::Segments rod = quiet_rod(1e8f, 1e8f);
  for (auto& s : rod) s.stretch_modulus_pa = 1e6f;
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {9.81f, 0, 0}});
  settle(batch);
  const double expected = 1000 * 9.81 * std::pow(free_length(rod), 2) / (2 * 1e6);
  CHECK(test::end_of(batch, rod, kSegments - 1)[0] - 1 == Approx(expected).epsilon(kTheory));
}

TEST_CASE("damping_does_not_change_where_a_rod_comes_to_rest") {
  test::Segments rod = quiet_rod(1e6f, 1e6f);
  test::RodBatch damped = test::batch_of({rod});
  for (auto& s : rod) s.damping_s = 0.5f;
  test::RodBatch thick = test::batch_of({rod});
  settle(damped);
  settle(thick);
  settle(thick);
  for (uint32_t i = 0; i < kSegments; ++i) {
    CHECK(test::distance(damped.pose(0, i).position_m, thick.pose(0, i).position_m) < 1e-4);
  }
}

TEST_CASE("rod_rest_shape_is_a_fixed_point") {
  const test::Segments rod = test::helix(40);
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  for (int i = 0; i < 1000; ++i) test::step(batch, 0.02f);
  for (uint32_t i = 0; i < 40; ++i) {
    // Orientations are given in single precision: joints of a segment 20 mm long begin some nanometres apart.
    CHECK(test::distance(batch.pose(0, i).position_m, rod[i].position_m) < 1e-6);
  }
}
