// test_contact_forces.cpp  What contacts do: rest, slide, hand momentum on, drape, push out; whatever the
// start.
#include "tests/rods/contact_scenes.hpp"
#include "tests/scenes/hair_on_head.hpp"

using namespace sinew;

namespace {

constexpr double kGravity = 9.81;
// Penetration that is left alone is two of the default tolerance of 0.01; the issue asks for 0.05.
constexpr float kDeepest = 0.05f;

rods::RodCollider on_floor(const test::RodBatch& batch, const rods::Plane& floor = {},
                           rods::ColliderSettings settings = {}) {
  rods::RodCollider collider = test::collider_of(batch, settings);
  REQUIRE(collider.set_planes({&floor, 1}).ok());
  return collider;
}

float weight_n(const rods::SegmentDef& s) {
  const double square = static_cast<double>(s.radius_m) * static_cast<double>(s.radius_m);
  return static_cast<float>(kGravity * M_PI * square * static_cast<double>(s.length_m * s.density_kg_m3));
}

struct Slide {
  double acceleration, way;
};

// On an incline of `angle`, along it, for two seconds; acceleration of the second.
Slide slide(double angle, float friction, test::RodSettings settings = {}) {
  const auto along = static_cast<float>(kGravity * std::sin(angle)),
             down = static_cast<float>(kGravity * std::cos(angle));
  settings.gravity_m_s2[0] = along;
  settings.gravity_m_s2[1] = -down;
  const test::Segments rod = test::lying_rod(0.01);
  test::RodBatch batch = test::batch_of({rod}, settings);
  rods::RodCollider collider = on_floor(batch, {.friction = friction});
  for (int i = 0; i < 60; ++i) test::step(batch, collider);
  const double half = test::mean_velocity(batch, 0)[0];
  for (int i = 0; i < 60; ++i) test::step(batch, collider);
  return {test::mean_velocity(batch, 0)[0] - half, batch.pose(0, 5).position_m[0] - rod[5].position_m[0]};
}

// Four limp bones, held at the first one's beginning, fall across a bar of which the last hangs over; four
// seconds.
struct Tail {
  rods::Vector tip;
  uint32_t contacts;
};
Tail tail_over_bar(float friction, int steps_per_s) {
  test::Segments tail = test::straight_rod(
      {.segments = 5, .young_pa = 2e4f, .length_m = 0.5, .radius_m = 0.02f, .torsion_pa = 2e4f});
  for (auto& s : tail) s.position_m[0] -= 0.1, s.damping_s = 0.01f, s.drag_per_s = 0.5f;
  test::RodBatch batch = test::batch_of({tail});
  rods::RodCollider collider = test::collider_of(batch);
  const rods::Capsule bar = {
      .ends_m = {{0.25, -0.08, -0.2}, {0.25, -0.08, 0.2}}, .radius_m = 0.03f, .friction = friction};
  REQUIRE(collider.set_capsules({&bar, 1}).ok());
  test::RodReport report;
  for (int i = 0; i < 4 * steps_per_s; ++i) {
    report = test::step(batch, collider, 1.0f / static_cast<float>(steps_per_s));
  }
  return {test::end_of(batch, tail, 4), report.contacts};
}

struct Sliding {
  uint32_t unconverged;
  float deepest;
};

// Hair on a head that turns to and fro: two seconds, after as many in which it comes to lie.
Sliding slide_over_head(uint32_t strands, const test::RodSettings& settings) {
  const test::HairOnHead hair(strands);
  test::RodBatch batch = hair.batch(settings);
  rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false});
  Sliding out = {};
  for (int i = 0; i < 240; ++i) {
    const double now = i * static_cast<double>(test::kFrame_s),
                 then = now + static_cast<double>(test::kFrame_s);
    const double turn = hair.angle(then, true) - hair.angle(now, true);
    hair.turn(&batch, then);
    REQUIRE(test::HairOnHead::put(&collider, turn / static_cast<double>(test::kFrame_s)).ok());
    const test::RodReport report = test::step(batch, collider);
    if (i < 120) continue;
    out.unconverged += report.contacts_unconverged;
    out.deepest = std::max(out.deepest, report.deepest_penetration);
  }
  return out;
}

}  // namespace

TEST_CASE("a_rod_that_falls_on_a_plane_comes_to_rest_on_it") {
  for (const float young : {1e5f, 1e7f, 1e9f}) {
    for (const double turn : {0.0, 0.1, 1.0}) {
      test::Segments rod = test::lying_rod(0.6, 12, young);
      for (auto& s : rod) {  // turned about z
        const double x = s.position_m[0] - 0.5;
        s.position_m[0] = x * std::cos(turn), s.position_m[1] += x * std::sin(turn);
        const rods::Turn q =
            rods::product({0, 0, std::sin(turn / 2), std::cos(turn / 2)}, rods::turn_of(s.orientation));
        for (size_t k = 0; k < 4; ++k) s.orientation[k] = static_cast<float>(q[k]);
        s.damping_s = 0.02f;
      }
      test::RodBatch batch = test::batch_of({rod});
      rods::RodCollider collider = on_floor(batch);
      const double thrown = test::energy(batch, rod, kGravity).height_j;
      INFO("E " << young << ", turned by " << turn);
      for (int i = 0; i < 400; ++i) {
        test::step(batch, collider);
        CHECK(test::energy(batch, rod, kGravity).sum_j() < 1.001 * thrown);
      }
      for (int i = 0; i < 100; ++i) {
        const test::RodReport report = test::step(batch, collider);
        CHECK(report.deepest_penetration < kDeepest);
        CHECK(report.recovered + report.rejoined == 0);
        // Jitter: a tolerance a step, 1e-4 m at 60 Hz.
        CHECK(std::fabs(batch.velocity(0, 6).linear_m_s[1]) < 0.006f);
      }
      CHECK(test::energy(batch, rod, kGravity).kinetic_j < 1e-3 * thrown);
    }
  }
}

TEST_CASE("a_rod_slides_down_an_incline_only_where_it_is_steeper_than_friction_holds") {
  // Within half a per cent of g: a tolerance of 1e-4 m a step would be 0.36 m/s^2 were it all on one side.
  constexpr double kAcceleration = 0.05;
  for (const float friction : {0.2f, 0.5f, 1.0f}) {
    for (const double share : {0.5, 0.9, 0.97, 1.03, 1.1, 1.5}) {
      const double angle = std::atan(share * static_cast<double>(friction));
      const double expected = kGravity * (std::sin(angle) - static_cast<double>(friction) * std::cos(angle));
      const Slide found = slide(angle, friction);
      INFO("friction " << friction << ", slope over it " << share << ": " << found.acceleration);
      if (share < 1) {
        CHECK(std::fabs(found.way) < 1e-3);  // creep of two seconds: a tenth of the radius
      } else {
        CHECK(found.acceleration == Approx(expected).margin(kAcceleration));
      }
    }
  }
  CHECK(slide(0.3, 0).acceleration == Approx(kGravity * std::sin(0.3)).margin(0.01));
}

TEST_CASE("a_rod_at_rest_on_a_plane_goes_on_converging_at_the_finest_tolerance") {
  test::RodBatch batch =
      test::batch_of({test::lying_rod(0.01)}, {.max_iterations = 100, .tolerance_rad = 1e-6f});
  rods::RodCollider collider = on_floor(batch, {}, {.rods_collide = false, .tolerance = 1e-4f});
  for (int i = 0; i < 200; ++i) {
    const test::RodReport report = test::step(batch, collider);
    CHECK(report.contacts_unconverged == 0);
    CHECK(report.iterations <= 4);
  }
}

// Where it ends was integrated apart from this library: four links in joint angles, explicit steps of 4e-6 s,
// the contact a stiff spring, friction a bristle of bounded force. From 0.6 on it stays, its tip at
// (0.325, -0.104) with 0.6 and (0.320, -0.112) with 0.8; up to 0.4 it slides off, however slowly it is laid
// down. Where it stays friction leaves a range: laid down slowly, the tip is a centimetre from there.
TEST_CASE("a_limp_tail_slides_off_a_bar_unless_friction_holds_it") {
  for (const int steps_per_s : {60, 240}) {
    INFO(steps_per_s << " steps a second");
    for (const float friction : {0.0f, 0.3f, 0.4f}) {
      const Tail tail = tail_over_bar(friction, steps_per_s);
      CHECK(tail.contacts == 0);
      CHECK(tail.tip[0] < 0.25);
      CHECK(tail.tip[1] < -0.3);
    }
    for (const float friction : {0.6f, 0.8f}) {
      const Tail tail = tail_over_bar(friction, steps_per_s);
      CHECK(tail.contacts > 0);
      CHECK(test::distance(tail.tip, {0.322, -0.108, 0}) < 0.01);
    }
  }
}

TEST_CASE("rods_that_collide_keep_their_momentum") {
  for (const float young : {1e4f, 1e6f, 1e8f}) {
    for (const float heavy : {1.0f, 100.0f}) {
      test::Segments second = test::crossing_rod(0.55, 0.06, 10, young);
      for (auto& s : second) s.density_kg_m3 *= heavy;
      const test::Segments first = test::lying_rod(0, 10, young);
      test::RodBatch batch = test::batch_of({first, second}, {.gravity_m_s2 = {0, 0, 0}});
      rods::RodCollider collider = test::collider_of(batch);
      test::throw_rod(batch, 1, 0.3f, -2, 0);
      double kinetic = test::energy(batch, second, 0, 1).kinetic_j;
      const double mass = 1 / static_cast<double>(1 + heavy), own = static_cast<double>(heavy) * mass;
      INFO("E " << young << ", heavier by " << heavy);
      for (int i = 0; i < 30; ++i) test::step(batch, collider);
      const rods::Vector a = test::mean_velocity(batch, 0), b = test::mean_velocity(batch, 1);
      CHECK(a[1] < -0.2);  // they have met
      for (size_t k = 0; k < 2; ++k) {
        const double before = own * (k == 0 ? 0.3 : -2), after = mass * a[k] + own * b[k];
        CHECK(after == Approx(before).margin(0.01 * own * 2));  // the 1 %
      }
      CHECK(test::energy(batch, first, 0, 0).sum_j() + test::energy(batch, second, 0, 1).sum_j() <
            1.001 * kinetic);
    }
  }
}

TEST_CASE("a_strand_draped_over_a_capsule_and_one_over_a_sphere_hang_and_stay_outside") {
  for (const bool ball : {false, true}) {
    test::Segments rod = test::lying_rod(0.15, 30, 1e5f);
    for (auto& s : rod) s.damping_s = 0.05f, s.drag_per_s = 0.5f, s.radius_m = 0.006f;
    test::RodBatch batch = test::batch_of({rod});
    rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false});
    const rods::Capsule bar = {.ends_m = {{0.5, 0, -1}, {0.5, 0, 1}}, .radius_m = 0.1f, .friction = 0.8f};
    const rods::Sphere sphere = {.middle_m = {0.5, 0, 0}, .radius_m = 0.1f, .friction = 0.8f};
    REQUIRE((ball ? collider.set_spheres({&sphere, 1}) : collider.set_capsules({&bar, 1})).ok());
    test::RodReport report;
    for (int i = 0; i < (ball ? 150 : 400); ++i) {  // from a ball it slips off in the end
      report = test::step(batch, collider);
      CHECK(report.recovered + report.rejoined == 0);
    }
    INFO((ball ? "sphere" : "capsule"));
    CHECK(report.deepest_penetration < kDeepest);
    CHECK(report.contacts > 3);
    CHECK(batch.pose(0, 15).position_m[1] == Approx(0.106).margin(0.002));
    CHECK(batch.pose(0, 0).position_m[1] < -0.2);
    CHECK(batch.pose(0, 29).position_m[1] < -0.2);
    CHECK(test::largest_stretch(batch, rod) < 1e-3);
  }
}

// Pressed by its weight from both ends, so that friction is at its limit along some of it and holds the rest:
// of where it is held drags are not unique, and errors go from contact to contact. Twelve
// iterations are the most that settings give.
TEST_CASE("a_rope_over_a_bar_that_turns_to_and_fro_converges_in_two_iterations") {
  test::Segments rope = test::lying_rod(0.12, 40, 1e5f);
  for (auto& s : rope) s.damping_s = 0.05f, s.drag_per_s = 0.5f;
  test::RodBatch batch = test::batch_of({rope});
  rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false});
  double iterations = 0, unconverged = 0;
  for (int i = 0; i < 600; ++i) {
    const rods::Capsule bar = {
        .ends_m = {{0.5, 0, -1}, {0.5, 0, 1}},
        .radius_m = 0.1f,
        .friction = 0.5f,
        .motion = {.angular_rad_s = {0, 0, static_cast<float>(0.5 * std::sin(0.05 * i))}}};
    REQUIRE(collider.set_capsules({&bar, 1}).ok());
    const test::RodReport report = test::step(batch, collider, 1.0f / 120);
    CHECK(report.recovered + report.rejoined == 0);
    if (i < 200) continue;  // falls and comes to hang
    iterations += report.iterations / 400.0;
    unconverged += report.contacts_unconverged / 400.0;
    CHECK(report.contacts > 5);
    CHECK(report.deepest_penetration < kDeepest);
  }
  CHECK(iterations < 2);
  CHECK(unconverged < 0.1);
}

// Eighteen in ten thousand do; more where what may hold or slide is left to get there by the slip's own size,
// or may change its state but once a step.
TEST_CASE("hair_that_slides_over_a_head_that_turns_hardly_ever_ends_at_the_cap") {
  CHECK(slide_over_head(300, {}).unconverged < 0.002 * 300 * 120);
}

// What comes to touch late has few iterations left to be pushed out again: the last one goes no deeper than
// 0.02, those before it twice as deep each, of which the ones after it may be cut short by other contacts.
TEST_CASE("hair_that_ends_at_the_cap_is_left_no_deeper_than_a_tenth_of_its_radius") {
  const Sliding sliding = slide_over_head(100, {.start = rods::RodStart::kContinued, .max_iterations = 6});
  CHECK(sliding.unconverged > 20);
  CHECK(sliding.deepest < 0.1f);
}

// Pressed by ten per cent of its weight more in each step: what friction gives grows as steadily.
TEST_CASE("contact_forces_go_on_as_they_changed_where_the_rods_own_start_continues") {
  const auto iterations = [](rods::RodStart start) {
    const test::Segments rod = test::lying_rod(0.01);
    test::RodBatch batch = test::batch_of({rod}, {.start = start});
    rods::RodCollider collider = on_floor(batch, {.friction = 0.2f});
    test::throw_rod(batch, 0, 20, 0, 0);
    uint32_t sum = 0;
    for (int i = 0; i < 30; ++i) {
      for (uint32_t k = 0; k < batch.segment_count(); ++k) {
        REQUIRE(batch.set_force(0, k, {0, -0.1f * static_cast<float>(i) * weight_n(rod[k]), 0}).ok());
      }
      const test::RodReport report = test::step(batch, collider);
      CHECK(report.unconverged + report.contacts_unconverged == 0);
      if (i >= 10) sum += report.iterations;
    }
    return sum;
  };
  CHECK(iterations(rods::RodStart::kContinued) == 20);  // one a step
  CHECK(iterations(rods::RodStart::kPrevious) > 30);
}

TEST_CASE("what_starts_in_penetration_leaves_at_a_bounded_speed") {
  for (const float most : {0.2f, 1.0f, 3.0f}) {
    for (const int kind : {0, 1, 2}) {
      const test::Segments rod = test::lying_rod(-0.1), other = test::lying_rod(-0.0995);
      test::RodBatch batch = test::batch_of({rod, other}, {.gravity_m_s2 = {0, 0, 0}});
      rods::RodCollider collider =
          test::collider_of(batch, {.rods_collide = kind == 2, .largest_push_out_m_s = most});
      const rods::Plane floor;
      const rods::Capsule bar = {.ends_m = {{0.4, -0.25, -1}, {0.4, -0.25, 1}}, .radius_m = 0.2f};
      if (kind == 0) REQUIRE(collider.set_planes({&floor, 1}).ok());
      if (kind == 1) REQUIRE(collider.set_capsules({&bar, 1}).ok());
      INFO("at most " << most << " m/s, scene " << kind);
      test::RodReport report;
      double fastest = 0;
      for (int i = 0; i < 120; ++i) {
        report = test::step(batch, collider);
        CHECK(report.recovered + report.rejoined == 0);
        for (const uint32_t s : {0u, 1u})
          fastest = std::max(fastest, rods::length(test::mean_velocity(batch, s)));
      }
      CHECK(report.deepest_penetration < (kind == 0 && most < 0.5f ? 1.0f : kDeepest));
      // A tolerance, 1e-4 m a step, on top. Out of what is round its parts are pushed apart, which adds up.
      CHECK(fastest < (kind == 1 ? 2.5 : 1.02) * static_cast<double>(most));
      CHECK(fastest > (kind == 2 ? 0.01 : 0.5) * static_cast<double>(most));
    }
  }
}

TEST_CASE("a_rod_through_the_axis_of_a_capsule_comes_out_and_stays_out") {
  for (const float young : {1e4f, 1e6f, 1e8f}) {
    for (const bool held : {false, true}) {
      for (const double off : {0.0, 1e-4, 3e-3}) {
        for (const float radius : {0.02f, 0.1f, 0.2f}) {
          test::Segments rod = test::lying_rod(off, 10, young);
          rod[0].fixed = held;
          test::RodBatch batch = test::batch_of({rod});
          rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false});
          const rods::Capsule bar = {.ends_m = {{0.53, 0, -1}, {0.53, 0, 1}}, .radius_m = radius};
          REQUIRE(collider.set_capsules({&bar, 1}).ok());
          for (int i = 0; i < 240; ++i) test::step(batch, collider);
          INFO("E " << young << ", held " << held << ", off by " << off << ", radius " << radius);
          for (uint32_t i = 0; i < 10; ++i) {
            for (const double half : {-0.05, 0.0, 0.05}) {
              const rods::SegmentPose pose = batch.pose(0, i);
              const rods::Vector z = test::axis_of(pose);
              const double x = pose.position_m[0] + half * z[0] - 0.53, y = pose.position_m[1] + half * z[1];
              // A fifth of the rod's radius: some of them still slide.
              CHECK(std::hypot(x, y) > static_cast<double>(radius) + 0.008);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("a_step_of_rods_that_touch_and_converge_does_not_depend_on_where_its_iteration_starts") {
  // Exact: the rods' own tolerance and the contacts' 1e-3 of a centimetre.
  const auto settings = [](rods::RodStart start) {
    return test::RodSettings{.start = start, .max_iterations = 1000, .tolerance_rad = 3e-4f};
  };
  const test::Segments rod = test::lying_rod(0.05, 10, 1e6f);
  test::RodBatch zero = test::batch_of({rod}, settings(rods::RodStart::kZero));
  test::RodBatch previous = test::batch_of({rod}, settings(rods::RodStart::kPrevious));
  rods::RodCollider a = on_floor(zero, {}, {.tolerance = 1e-3f}),
                    b = on_floor(previous, {}, {.tolerance = 1e-3f});
  test::throw_rod(previous, 0, 1, 0, 0.5f);  // falls, slides, stops
  double largest = 0;
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    REQUIRE(zero.take_state(previous).ok());
    const test::RodReport one = test::step(zero, a), two = test::step(previous, b);
    // Impacts of soft rods may go on opening and closing contacts to the cap; what ended is compared.
    if (one.unconverged + two.unconverged + one.contacts_unconverged + two.contacts_unconverged > 0) continue;
    compared += one.contacts > 0 && two.contacts > 0;
    for (const uint32_t s : {0u, 1u}) {
      for (uint32_t k = 0; k < 10; ++k) {
        largest =
            std::max(largest, test::distance(zero.pose(s, k).position_m, previous.pose(s, k).position_m));
      }
    }
  }
  INFO("apart by " << largest << " m in " << compared << " steps");
  CHECK(compared >= 5);
  // What the tolerance lets be left, 1e-6 m, times how slowly the last of it goes.
  CHECK(largest < 2e-5);
}

TEST_CASE("what_begins_clear_of_a_wall_is_held_by_it_where_its_root_pulls_it_there_within_the_step") {
  // Hangs with a tenth of its radius between it and the wall: free motion leads along the wall, the first
  // iterate presses nothing.
  test::Segments rod =
      test::straight_rod({.segments = 6, .young_pa = 1e7f, .length_m = 0.6, .radius_m = 0.01f});
  const rods::Plane wall = {.point_m = {0, -0.011, 0}, .normal = {0, 1, 0}};
  test::RodSettings settings;
  settings.gravity_m_s2[0] = 9.81f, settings.gravity_m_s2[1] = 0;
  test::RodBatch batch = test::batch_of({rod}, settings);
  rods::RodCollider collider = on_floor(batch, wall, {.rods_collide = false});
  rods::SegmentPose root = batch.pose(0, 0);
  root.position_m[1] -= 0.01;
  REQUIRE(batch.set_target(0, 0, root).ok());
  const test::RodReport report = test::step(batch, collider);
  CHECK(report.contacts >= 5);
  CHECK(report.contacts_unconverged == 0);
  for (uint32_t i = 1; i < 6; ++i) CHECK(test::end_of(batch, rod, i)[1] > -0.001 - kDeepest * 0.01);
}

TEST_CASE("a_rod_just_above_a_floor_that_another_is_thrown_onto_is_held_by_the_floor_in_the_same_step") {
  test::RodSettings settings;
  settings.gravity_m_s2[1] = 0;
  test::RodBatch batch = test::batch_of({test::lying_rod(0.0105), test::crossing_rod(0.5, 0.0315)}, settings);
  test::throw_rod(batch, 1, 0, -3, 0);
  rods::RodCollider collider = on_floor(batch);
  test::step(batch, collider);
  for (uint32_t i = 0; i < 10; ++i) CHECK(batch.pose(0, i).position_m[1] > 0.01 * (1 - kDeepest));
}

TEST_CASE("given_contact_points_hold_a_rod_for_the_coming_step_alone") {
  const test::Segments rod = test::lying_rod(0.5);
  test::RodBatch batch = test::batch_of({rod});
  rods::RodCollider collider = test::collider_of(batch);
  for (int i = 0; i < 60; ++i) {  // a floor at 0.49 that somebody else found, at both ends and joints
    std::vector<rods::ContactPoint> points;
    for (uint32_t k = 0; k < 10; ++k) {
      for (const float along : {-1.0f, 1.0f}) {
        points.push_back({.segment = k,
                          .along = along,
                          .gap_m = batch.pose(0, k).position_m[1] - 0.5,
                          .name = 2 * k + (along > 0)});
      }
    }
    REQUIRE(collider.set_points(points).ok());
    test::step(batch, collider);
  }
  CHECK(batch.pose(0, 5).position_m[1] == Approx(0.5).margin(5e-4));
  for (int i = 0; i < 30; ++i) test::step(batch, collider);
  CHECK(batch.pose(0, 5).position_m[1] < 0);
}

TEST_CASE("a_moving_plane_carries_a_rod_along_by_friction_and_up_by_its_normal") {
  test::RodBatch batch = test::batch_of({test::lying_rod(0.01)});
  rods::RodCollider collider = test::collider_of(batch);
  for (int i = 1; i <= 60; ++i) {
    const rods::Plane lift = {
        .point_m = {0, 0.5 * i / 60.0, 0}, .friction = 1, .motion = {.linear_m_s = {0.3f, 0.5f, 0}}};
    REQUIRE(collider.set_planes({&lift, 1}).ok());
    test::step(batch, collider);
  }
  const rods::Vector v = test::mean_velocity(batch, 0);
  CHECK(v[0] == Approx(0.3).margin(0.01));
  CHECK(v[1] == Approx(0.5).margin(0.01));
  CHECK(batch.pose(0, 5).position_m[1] == Approx(0.51).margin(5e-4));
}

TEST_CASE("a_strand_that_touches_nothing_moves_as_if_alone") {
  const test::Segments far = test::helix(12, 0.05), low = [] {
    test::Segments rod = test::lying_rod(-5, 12);
    for (auto& s : rod) s.position_m[0] += 50;
    return rod;
  }();
  std::vector<test::Segments> strands(16, low);
  strands[15] = far;
  test::RodBatch batch = test::batch_of(strands), alone = test::batch_of({far});
  rods::RodCollider collider = test::collider_of(batch), own = test::collider_of(alone);
  const rods::Plane floor = {.point_m = {0, -5.005, 0}};
  REQUIRE((collider.set_planes({&floor, 1}).ok() && own.set_planes({&floor, 1}).ok()));
  for (int i = 0; i < 40; ++i) test::step(batch, collider), test::step(alone, own);
  for (uint32_t i = 0; i < 12; ++i) {
    CHECK(test::distance(batch.pose(15, i).position_m, alone.pose(0, i).position_m) == 0);
  }
}

TEST_CASE("a_strand_that_touches_something_does_not_know_of_its_neighbours") {
  // Each falls on the same bar from another height: they wake at other iterations, in one group.
  std::vector<test::Segments> strands;
  for (int i = 0; i < 18; ++i) strands.push_back(test::lying_rod(0.032 + 0.021 * i, 7));
  const rods::Capsule bar = {.ends_m = {{0.2, -0.05, -1}, {0.2, 0.05, 1}}, .radius_m = 0.03f};
  test::RodBatch batch = test::batch_of(strands);
  rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false});
  REQUIRE(collider.set_capsules({&bar, 1}).ok());
  for (int i = 0; i < 40; ++i) test::step(batch, collider);
  for (uint32_t s = 0; s < 18; ++s) {
    test::RodBatch alone = test::batch_of({strands[s]});
    rods::RodCollider own = test::collider_of(alone, {.rods_collide = false});
    REQUIRE(own.set_capsules({&bar, 1}).ok());
    for (int i = 0; i < 40; ++i) test::step(alone, own);
    INFO("strand " << s);
    for (uint32_t i = 0; i < 7; ++i) {
      CHECK(test::distance(batch.pose(s, i).position_m, alone.pose(0, i).position_m) == 0);
    }
  }
}

// They go on for different numbers of iterations, packed into lanes of other groups than their own, and in
// the first steps more of them than there is room for.
TEST_CASE("strands_have_the_same_bits_in_whichever_order_they_slide_over_a_head") {
  const test::HairOnHead hair(150);
  const std::vector<test::Segments> reversed(hair.strands().rbegin(), hair.strands().rend());
  const test::RodSettings settings = {.start = rods::RodStart::kContinued};
  test::RodBatch batches[2] = {hair.batch(settings), test::batch_of(reversed, settings)};
  for (test::RodBatch& batch : batches) {
    rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false});
    uint32_t longest = 0;
    for (int i = 0; i < 60; ++i) {
      REQUIRE(test::HairOnHead::put(&collider, i % 20 < 10 ? 3 : -3).ok());
      longest = std::max(longest, test::step(batch, collider).iterations);
    }
    CHECK(longest == settings.max_iterations);
  }
  for (uint32_t s = 0; s < 150; ++s) {
    for (uint32_t i = 0; i < hair.strands()[0].size(); ++i) {
      const rods::SegmentPose one = batches[0].pose(s, i), other = batches[1].pose(149 - s, i);
      CHECK(test::distance(one.position_m, other.position_m) == 0);
    }
  }
}

TEST_CASE("a_pile_stays_bounded_for_ten_thousand_steps") {
  std::vector<test::Segments> strands;
  for (int i = 0; i < 8; ++i) {
    test::Segments rod = i % 2 ? test::crossing_rod(0.35 + 0.04 * i, 0.05 + 0.03 * i, 6, 1e6f)
                               : test::lying_rod(0.05 + 0.03 * i, 6, 1e6f);
    for (auto& s : rod) s.damping_s = 0.02f, s.drag_per_s = 0.1f;
    strands.push_back(rod);
  }
  test::RodBatch batch = test::batch_of(strands);
  rods::RodCollider collider = on_floor(batch);
  uint32_t recovered = 0, dropped = 0;
  double fastest = 0, lowest = 1, highest = 0;
  for (int i = 0; i < 10000; ++i) {
    const test::RodReport report = test::step(batch, collider);
    recovered += report.recovered + report.rejoined;
    dropped += report.contacts_dropped;
    for (uint32_t s = 0; i > 300 && s < 8; ++s) {
      fastest = std::max(fastest, rods::length(test::mean_velocity(batch, s)));
      lowest = std::min(lowest, batch.pose(s, 3).position_m[1]);
      highest = std::max(highest, batch.pose(s, 3).position_m[1]);
    }
  }
  CHECK(recovered == 0);
  CHECK(dropped == 0);
  CHECK(fastest < 1.5);   // a fall from the height of the pile, 0.1 m
  CHECK(lowest > 0);      // never a radius deep
  CHECK(highest < 0.25);  // where it was dropped from
}
