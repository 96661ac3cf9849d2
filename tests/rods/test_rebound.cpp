// test_rebound.cpp  Restitution: what is fast leaves with its share of the speed, what is slow stays.
#include "tests/rods/capsule_source.hpp"

using namespace sinew;

namespace {

// Upward speed after a fall without gravity onto what `meets` is given.
template <class Meets>
double speed_after(double speed_m_s, const Meets& meets) {
  const test::Segments rod = test::lying_rod(0.05);
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false, .source_capacity = 64});
  test::throw_rod(batch, 0, 0.5f, static_cast<float>(-speed_m_s), 0);
  for (int i = 0; i < 30; ++i) {
    meets(batch, collider);
    CHECK(test::step(batch, collider).deepest_penetration < 0.05f);
  }
  return test::mean_velocity(batch, 0)[1];
}

}  // namespace

TEST_CASE("a_rod_leaves_an_obstacle_with_the_share_of_its_speed_that_restitution_says") {
  for (const float e : {0.0f, 0.3f, 0.8f, 1.0f}) {
    const rods::Plane floor = {.friction = 0, .restitution = e};
    const rods::Sphere ball = {.middle_m = {0.55, -1, 0}, .radius_m = 1, .friction = 0, .restitution = e};
    const rods::Capsule log = {
        .ends_m = {{-9, -1, 0}, {9, -1, 0}}, .radius_m = 1, .friction = 0, .restitution = e};
    const auto on_floor = [&](const test::RodBatch&, rods::RodCollider& c) {
      REQUIRE(c.set_planes({&floor, 1}).ok());
    };
    const auto on_log = [&](const test::RodBatch&, rods::RodCollider& c) {
      REQUIRE(c.set_capsules({&log, 1}).ok());
    };
    INFO("restitution " << e);
    const double share = static_cast<double>(e);
    // All of a stiff rod that lands flat turns round at once.
    CHECK(speed_after(2, on_floor) == Approx(2 * share).margin(0.02));
    CHECK(speed_after(2, on_log) == Approx(2 * share).margin(0.02));
    // Slower than kSlowestRebound_m_s: it stays.
    CHECK(std::fabs(speed_after(0.15, on_floor)) < 0.01);
    const auto on_ball = [&](const test::RodBatch&, rods::RodCollider& c) {
      REQUIRE(c.set_spheres({&ball, 1}).ok());
    };
    if (e > 0) CHECK(speed_after(2, on_ball) > 0.05 * share);
    test::FloorSource source(0, {0, 0, 0}, e);
    const auto on_source = [&](const test::RodBatch&, rods::RodCollider& c) {
      REQUIRE(c.set_source(&source).ok());
    };
    CHECK(speed_after(2, on_source) == Approx(2 * share).margin(0.02));
    const auto on_points = [&](const test::RodBatch& batch, rods::RodCollider& c) {
      std::vector<rods::ContactPoint> points;
      for (uint32_t i = 0; i < 10; ++i) {
        points.push_back(
            {.segment = i, .gap_m = batch.pose(0, i).position_m[1] - 0.01, .friction = 0, .restitution = e});
      }
      REQUIRE(c.set_points(points).ok());
    };
    CHECK(speed_after(2, on_points) == Approx(2 * share).margin(0.02));
  }
}

TEST_CASE("a_rod_that_bounces_under_gravity_loses_energy_and_comes_to_rest") {
  const test::Segments rod = test::lying_rod(0.3);
  test::RodBatch batch = test::batch_of({rod});
  rods::RodCollider collider = test::collider_of(batch);
  const rods::Plane floor = {.restitution = 0.7f};
  REQUIRE(collider.set_planes({&floor, 1}).ok());
  double highest = 0;
  const double thrown = test::energy(batch, rod, 9.81).sum_j();
  for (int i = 0; i < 400; ++i) {
    test::step(batch, collider);
    CHECK(test::energy(batch, rod, 9.81).sum_j() < 1.01 * thrown);
    if (i > 16) highest = std::max(highest, batch.pose(0, 5).position_m[1]);
  }
  // e^2 of 0.29 m above where it lies, within what a step's length makes of it: half of g dt of 2.4 m/s.
  CHECK(highest - 0.01 == Approx(0.49 * 0.29).margin(0.03));
  CHECK(std::fabs(batch.velocity(0, 5).linear_m_s[1]) < 0.01f);
}
