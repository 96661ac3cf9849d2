// test_touch.cpp  Nearest points of an axis, and when a way first touches.
#include "adapters/bullet/touch.hpp"

#include <random>

#include "tests/bullet/probes.hpp"

using namespace sinew;
using namespace sinew::bullet;
using rods::Vector;

TEST_CASE("an_axis_of_no_length_is_a_point_and_one_through_a_sphere_s_middle_has_a_normal") {
  const Convex sphere = convex_of(btSphereShape(1));
  const Axis point = {{0, 3, 0}, {0, 3, 0}};
  CHECK(nearest(sphere, point, 1e-6).distance.m == 2);
  Near out[4];
  CHECK(supports(sphere, point, nearest(sphere, point, 1e-6), 0.1, 1, out) == 1);
  const Near through = nearest(sphere, {{-1, 0, 0}, {1, 0, 0}}, 1e-6);
  CHECK(through.distance.m == Approx(-1).margin(1e-6));
  CHECK(rods::length(through.distance.normal) == Approx(1));
}

TEST_CASE("the_nearest_point_of_an_axis_is_the_nearest_of_many") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  const btBoxShape box(btVector3(0.5f, 0.2f, 0.9f));
  const btCylinderShape cylinder(btVector3(0.4f, 0.6f, 0.4f));
  for (int i = 0; i < 200; ++i) {
    const Axis axis = {{any(random), any(random), any(random)}, {any(random), any(random), any(random)}};
    for (const btConvexShape* shape :
         {static_cast<const btConvexShape*>(&box), static_cast<const btConvexShape*>(&cylinder)}) {
      const Convex convex = convex_of(*shape);
      double least = 1e9;
      for (int k = 0; k <= 1000; ++k) least = std::min(least, distance(convex, axis.at(0.001 * k)).m);
      const double found = nearest(convex, axis, 1e-5).distance.m;
      CHECK(found <= least + 1e-5);
      CHECK(found >= least - 0.003);  // the points' spacing
    }
  }
}

// What is asked for within a distance is told exactly there, and as further away beyond it.
TEST_CASE("an_axis_is_as_near_as_it_is_within_reach_and_beyond_reach_beyond_it") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  const btBoxShape box(btVector3(0.5f, 0.2f, 0.9f));
  const btCylinderShape cylinder(btVector3(0.4f, 0.6f, 0.4f));
  const btCapsuleShape capsule(0.3f, 0.8f);
  const btConeShape cone(0.4f, 0.8f);  // by GJK
  const Triangle triangle = {{Vector{0, 0, 0}, Vector{1, 0, 0}, Vector{0, 0, 1}}, 0};
  const Convex shapes[] = {convex_of(box), convex_of(cylinder), convex_of(capsule), convex_of(cone),
                           convex_of(triangle)};
  constexpr double kExact_m = 1e-4;
  uint32_t far = 0;
  for (int i = 0; i < 400; ++i) {
    const Axis axis = {{any(random), any(random), any(random)}, {any(random), any(random), any(random)}};
    const double reach_m = 0.5 + 0.5 * any(random);
    for (const Convex& shape : shapes) {
      const double all = nearest(shape, axis, kExact_m).distance.m;
      const double within = nearest(shape, axis, kExact_m, reach_m).distance.m;
      INFO("kind " << shape.kind << ": " << all << " m, asked within " << reach_m << ": " << within);
      far += all > reach_m;
      if (all > reach_m + kExact_m)
        CHECK(within > reach_m);
      else if (all < reach_m - kExact_m)
        CHECK(std::fabs(within - all) <= kExact_m);
    }
  }
  CHECK(far > 200);
}

// Where it has risen by five thousandths of its radius: over a bar as a parabola, from a box's edge in a
// straight line.
TEST_CASE("an_axis_that_rises_slowly_is_carried_where_it_leaves_the_flat_part") {
  constexpr double kRadius_m = 0.01, kRise_m = 0.005 * kRadius_m;
  const auto first_share = [&](const Convex& shape, const Axis& axis) {
    Near out[4];
    REQUIRE(supports(shape, axis, nearest(shape, axis, 1e-8), kRadius_m, 0, out) == 2);
    return std::min(out[0].share, out[1].share);
  };
  const Convex bar = convex_of(btCylinderShapeZ(btVector3(0.2f, 0.2f, 1)));
  const double half_m = std::sqrt(std::pow(0.21 + kRise_m, 2) - 0.21 * 0.21);
  CHECK(first_share(bar, {{-0.03, 0.21, 0}, {0.03, 0.21, 0}}) ==
        Approx(0.5 - half_m / 0.06).margin(0.03 * half_m / 0.06));
  const Convex box = convex_of(btBoxShape(btVector3(0.2f, 0.2f, 1)));
  const double steep = 0.004, long_m = kRise_m / steep;
  CHECK(first_share(box, {{0.1, 0.21 + 0.1 * steep, 0}, {0.3, 0.21 - 0.1 * steep, 0}}) ==
        Approx(0.5 - long_m / 0.2).margin(0.05 * long_m / 0.2));
}

TEST_CASE("a_way_first_touches_when_the_surfaces_meet") {
  const Convex sphere = convex_of(btSphereShape(1));
  const Motion still = Motion::ending_at(kHere, {}, {});
  const Path down = {{{0, 5, 0}, {0, 5, 0}}, {{0, -5, 0}, {0, -5, 0}}, 0.5};
  const Touch touch = first_touch(sphere, kHere, still, down, down.closing_m(still), 0);
  CHECK(touch.time == Approx(0.35).margin(0.001));
  // A bar that turns by a radian and is ten metres long meets what waits beside it on an arc, not on a chord.
  const Convex bar = convex_of(btBoxShape(btVector3(10, 0.01f, 0.01f)));
  const Motion turns =
      Motion::ending_at(place_of(btTransform(btQuaternion(btVector3(0, 0, 1), 1.0f))), {}, {0, 0, 1});
  const Vector waits = {9.98 * std::cos(0.5), 9.98 * std::sin(0.5), 0};
  const Path here = {{waits, waits}, {waits, waits}, 0.01};
  CHECK(first_touch(bar, kHere, turns, here, here.closing_m(turns), 0).time == Approx(0.5).margin(0.005));
}

TEST_CASE("a_face_carries_what_is_above_it") {
  const Triangle t = {{Vector{0, 0, 0}, Vector{2, 0, 0}, Vector{0, 0, 2}}, 0};
  Near out[2];
  // Winding looks down.
  CHECK(face_supports(t, -1, {{-1, 0.1, 0.5}, {3, 0.1, 0.5}}, 0.1, 0.01, out) == 2);
  CHECK(out[0].share == Approx(0.25));
  CHECK(out[1].share == Approx(0.625));
  CHECK(out[0].distance.m == Approx(0.1));
  CHECK(out[0].distance.normal[1] == Approx(1));
  CHECK(face_supports(t, -1, {{-1, 0.1, -0.5}, {3, 0.1, -0.5}}, 0.1, 0.01, out) == 0);
  CHECK(face_supports(t, -1, {{0.5, 0.5, 0.5}, {0.5, -0.3, 0.5}}, 0.1, 0.01, out) == 1);
  CHECK(out[0].distance.m == Approx(-0.3));
}
