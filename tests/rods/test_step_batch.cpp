// test_step_batch.cpp  Motion: momentum, energy, length, damping, drag, starts.
#include <catch2/catch.hpp>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

constexpr double kGravity = 9.81;

rods::Vector momentum(const test::RodBatch& batch, const test::Segments& segments) {
  rods::Vector sum = {};
  for (uint32_t i = 0; i < segments.size(); ++i) {
    const rods::SegmentVelocity v = batch.velocity(0, i);
    for (size_t k = 0; k < 3; ++k) {
      sum[k] += rods::segment_inertia(segments[i]).mass_kg * static_cast<double>(v.linear_m_s[k]);
    }
  }
  return sum;
}

// About the world's origin.
rods::Vector angular_momentum(const test::RodBatch& batch, const test::Segments& segments) {
  rods::Vector sum = {};
  for (uint32_t i = 0; i < segments.size(); ++i) {
    const rods::SegmentPose pose = batch.pose(0, i);
    const rods::SegmentVelocity v = batch.velocity(0, i);
    const rods::SegmentInertia inertia = rods::segment_inertia(segments[i]);
    const rods::Turn q = rods::turn_of(pose.orientation);
    rods::Vector own = rods::turned_back(q, rods::vector_of(v.angular_rad_s));
    own = {own[0] * inertia.inertia_kg_m2, own[1] * inertia.inertia_kg_m2,
           own[2] * inertia.axial_inertia_kg_m2};
    const rods::Vector spin = rods::turned(q, own);
    for (size_t k = 0; k < 3; ++k) {
      const size_t a = (k + 1) % 3, b = (k + 2) % 3;
      sum[k] += spin[k] + inertia.mass_kg * (pose.position_m[a] * static_cast<double>(v.linear_m_s[b]) -
                                             pose.position_m[b] * static_cast<double>(v.linear_m_s[a]));
    }
  }
  return sum;
}

// A free rod that tumbles and waves.
test::RodBatch tumbling(const test::Segments& rod) {
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  for (uint32_t i = 0; i < rod.size(); ++i) {
    const float x = static_cast<float>(rod[i].position_m[0]) - 0.5f;
    REQUIRE(batch.set_velocity(0, i, {{0.3f, 2 * x, std::sin(6 * x)}, {0, -6 * std::cos(6 * x), 2}}).ok());
  }
  return batch;
}

test::Segments free_rod() {
  return test::straight_rod(
      {.segments = 20, .young_pa = 1e6f, .length_m = 1, .radius_m = 0.01f, .held = false});
}

double angular_change(float dt_s) {
  const test::Segments rod = free_rod();
  test::RodBatch batch = tumbling(rod);
  test::step(batch, dt_s);  // what the velocities given above hold against the joints is lost in a first step
  const rods::Vector before = angular_momentum(batch, rod);
  const int steps = static_cast<int>(std::lround(0.2f / dt_s));
  for (int i = 0; i < steps; ++i) test::step(batch, dt_s);
  return test::distance(before, angular_momentum(batch, rod)) / std::hypot(before[0], before[1], before[2]);
}

}  // namespace

TEST_CASE("a_free_rods_momentum_stays") {
  const test::Segments rod = free_rod();
  test::RodBatch batch = tumbling(rod);
  const rods::Vector before = momentum(batch, rod);
  for (int i = 0; i < 500; ++i) test::step(batch, 0.01f);
  const double scale = std::hypot(before[0], before[1], before[2]);
  CHECK(test::distance(before, momentum(batch, rod)) < 1e-4 * scale);  // 500 steps of single precision
}

TEST_CASE("a_free_rods_angular_momentum_stays_up_to_the_steps_order") {
  // Implicit Euler loses some in proportion to the step: a tenth of the step, a tenth of the loss.
  const double coarse = angular_change(0.01f), fine = angular_change(0.001f);
  INFO("lost in 0.2 s: " << coarse << " by steps of 10 ms, " << fine << " by 1 ms");
  CHECK(fine < 0.01);
  CHECK(fine < 0.2 * coarse);
}

TEST_CASE("a_single_free_top_keeps_its_spin_and_its_momentums_direction") {
  test::Segments rod = test::straight_rod({.segments = 2, .length_m = 0.2, .radius_m = 0.02f, .held = false});
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  for (const uint32_t i : {0u, 1u}) REQUIRE(batch.set_velocity(0, i, {{0, 0, 0}, {30, 0, 0}}).ok());
  for (int i = 0; i < 1000; ++i) test::step(batch, 0.005f);
  for (const uint32_t i : {0u, 1u}) {
    const rods::SegmentVelocity v = batch.velocity(0, i);
    CHECK(v.angular_rad_s[0] == Approx(30).epsilon(1e-3));
    CHECK(std::hypot(v.angular_rad_s[1], v.angular_rad_s[2]) < 0.03f);
  }
}

TEST_CASE("energy_does_not_grow") {
  for (const float young : {1e2f, 1e4f, 1e6f, 1e8f, 1e10f}) {
    for (const float dt : {0.002f, 0.02f, 0.1f}) {
      const test::Segments rod =
          test::straight_rod({.segments = 30, .young_pa = young, .torsion_pa = young / 3});
      test::RodBatch batch = test::batch_of({rod}, {.max_iterations = 100, .tolerance_rad = 1e-4f});
      double last = test::energy(batch, rod, kGravity).sum_j();
      const double fall = 30 * rods::segment_inertia(rod[0]).mass_kg * kGravity * 2;  // what gravity can give
      double grown = 0;
      for (int i = 0; i < 300; ++i) {
        test::step(batch, dt);
        const double now = test::energy(batch, rod, kGravity).sum_j();
        grown = std::max(grown, now - last);
        last = now;
      }
      INFO("E " << young << ", dt " << dt);
      // In a step: orientations of single precision leave 30 joints some 1e-7 rad each, squared and direct.
      CHECK(grown < 1e-4 * fall);
    }
  }
}

TEST_CASE("soft_rods_keep_their_length_at_default_settings") {
  for (const uint32_t segments : {50u, 100u, 200u}) {
    const test::Segments rod = test::straight_rod({.segments = segments, .young_pa = 1e4f});
    test::RodBatch batch = test::batch_of({rod});
    double longest = 0, stretch = 0;
    uint32_t unconverged = 0;
    for (int i = 0; i < 1000; ++i) {
      unconverged += test::step(batch, 0.02f).unconverged;
      longest = std::max(longest, test::length_ratio(batch, rod));
      stretch = std::max(stretch, test::largest_stretch(batch, rod));
    }
    INFO(segments << " segments");
    CHECK(longest < 1.0001);  // the issue asks 1.01 and hopes for 1.001
    CHECK(stretch < 1e-4);
    CHECK(unconverged == 0);
  }
}

TEST_CASE("rods_converge_at_every_stiffness_step_and_length") {
  for (const float dt : {0.001f, 0.02f, 0.1f}) {
    for (const uint32_t segments : {2u, 30u, 200u}) {
      for (float young = 1e2f; young < 2e12f; young *= 100) {
        const test::Segments rod = test::straight_rod({.segments = segments, .young_pa = young});
        test::RodBatch batch = test::batch_of({rod}, {.max_iterations = 40});
        uint32_t iterations = 0, unconverged = 0;
        for (int i = 0; i < 60; ++i) {
          const test::RodReport report = test::step(batch, dt);
          iterations += report.iterations_sum;
          unconverged += report.unconverged;
        }
        INFO("E " << young << ", dt " << dt << ", " << segments << " segments: " << iterations
                  << " iterations");
        CHECK(unconverged == 0);
        CHECK(iterations < 60 * 5);  // five a step on average
        CHECK(test::largest_stretch(batch, rod) < 1e-4);
      }
    }
  }
}

TEST_CASE("rods_that_bend_far_more_stiffly_than_they_twist_converge_at_default_settings") {
  for (const uint32_t segments : {10u, 30u, 100u}) {
    for (const float young : {1e8f, 1e9f, 1e10f}) {
      const test::Segments rod = test::straight_rod({.segments = segments, .young_pa = young});
      test::RodBatch batch = test::batch_of({rod});
      const double fall = segments * rods::segment_inertia(rod[0]).mass_kg * kGravity * 2;
      double last = test::energy(batch, rod, kGravity).sum_j(), grown = 0;
      uint32_t iterations = 0, unconverged = 0;
      for (int i = 0; i < 500; ++i) {
        const test::RodReport report = test::step(batch, 0.02f);
        iterations += report.iterations;
        unconverged += report.unconverged;
        const double now = test::energy(batch, rod, kGravity).sum_j();
        grown = std::max(grown, now - last);
        last = now;
      }
      INFO("E/G " << young / 1e6f << ", " << segments << " segments: " << iterations << " iterations");
      CHECK(unconverged == 0);
      CHECK(iterations < 500 * 5);
      CHECK(grown < 1e-3 * fall);  // what a hundredth of a radian leaves of a stiff rod's bending
    }
  }
}

TEST_CASE("damping_and_drag_take_energy_away") {
  const auto left = [](float damping_s, float drag_per_s) {
    test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e7f});
    for (auto& s : rod) {
      s.damping_s = damping_s;
      s.drag_per_s = drag_per_s;
    }
    test::RodBatch batch = test::batch_of({rod});
    for (int i = 0; i < 100; ++i) test::step(batch, 0.005f);
    return test::energy(batch, rod, kGravity).sum_j();
  };
  CHECK(left(0.2f, 0) < left(0, 0));
  CHECK(left(0, 5) < left(0, 0));
}

TEST_CASE("a_force_moves_a_free_rod_as_newton_says") {
  const test::Segments rod = free_rod();
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  for (uint32_t i = 0; i < 20; ++i) REQUIRE(batch.set_force(0, i, {0, 0, 0.01f}).ok());
  for (int i = 0; i < 100; ++i) test::step(batch, 0.01f);
  const double expected = 0.2 * 1.0;  // newtons times seconds
  CHECK(momentum(batch, rod)[2] == Approx(expected).epsilon(1e-4));
}

TEST_CASE("the_previous_start_saves_iterations_against_zero") {
  const auto iterations = [](rods::RodStart start) {
    test::RodBatch batch =
        test::batch_of({test::straight_rod({.segments = 50, .young_pa = 1e4f})}, {.start = start});
    uint32_t sum = 0;
    for (int i = 0; i < 200; ++i) sum += test::step(batch, 0.02f).iterations_sum;
    return sum;
  };
  CHECK(iterations(rods::RodStart::kPrevious) < iterations(rods::RodStart::kZero));
}
