// test_sweep.cpp  Nearest points of axes, and first touches, against dense sampling and by hand.
#include <catch2/catch.hpp>
#include <random>

#include "rods/contacts/find/sweep.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using rods::Axis;
using rods::Vector;

namespace {

Vector random_point(std::mt19937& random) {
  const auto one = [&] { return static_cast<double>(test::uniform(random, -1, 1)); };
  return {one(), one(), one()};
}

double distance_at(const Axis& a, const Axis& b, double s, double t) {
  return rods::length(rods::difference(rods::between(a.from, a.to, s), rods::between(b.from, b.to, t)));
}

double sampled_distance(const Axis& a, const Axis& b, int samples) {
  double least = HUGE_VAL;
  for (int i = 0; i <= samples; ++i) {
    for (int k = 0; k <= samples; ++k) {
      least = std::min(least,
                       distance_at(a, b, static_cast<double>(i) / samples, static_cast<double>(k) / samples));
    }
  }
  return least;
}

double nearest_distance(const Axis& a, const Axis& b) {
  const rods::Nearest n = rods::nearest(a, b);
  CHECK((n.a >= 0 && n.a <= 1 && n.b >= 0 && n.b <= 1));
  return distance_at(a, b, n.a, n.b);
}

}  // namespace

TEST_CASE("nearest_points_of_axes_are_as_near_as_any_sampled") {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const Axis a = {random_point(random), random_point(random)},
               b = {random_point(random), random_point(random)};
    const double exact = nearest_distance(a, b), sampled = sampled_distance(a, b, 60);
    CHECK(exact <= sampled + 1e-12);
    // Between samples a distance changes by at most a sixtieth of both lengths, 3.5 each.
    CHECK(exact >= sampled - 7.0 / 60);
  }
}

TEST_CASE("nearest_points_of_degenerate_axes_are_finite_and_right") {
  const Axis x = {{0, 0, 0}, {1, 0, 0}};
  CHECK(nearest_distance(x, {{0.3, 0.5, 0}, {0.3, 0.5, 0}}) == Approx(0.5));             // a point
  CHECK(nearest_distance({{2, 0, 0}, {2, 0, 0}}, {{2, 1, 0}, {2, 1, 0}}) == Approx(1));  // two
  CHECK(nearest_distance(x, {{0.5, 0.1, 0}, {3, 0.1, 0}}) == Approx(0.1));               // parallel
  CHECK(nearest_distance(x, {{3, 0, 0}, {2, 0, 0}}) == Approx(1));                       // in line
  CHECK(nearest_distance(x, {{0.5, 0, 0}, {2, 0, 0}}) == 0);                             // overlapping
  CHECK(nearest_distance(x, {{0.5, 0, -1}, {0.5, 0, 1}}) == 0);                          // crossing
  const rods::Nearest n = rods::nearest(x, {{0, 0.1, 0}, {1, 0.1, 0}});
  CHECK(n.a == Approx(0.5));  // side by side: the middle
}

TEST_CASE("a_first_touch_is_in_time_and_from_the_side_it_came") {
  const Axis bar = {{0, 0, -1}, {0, 0, 1}};
  const rods::Sweep still = {bar, bar, 0.05};
  for (const double way : {0.2, 1.0, 100.0}) {
    const Axis from = {{-0.5, 0.2, 0}, {0.5, 0.2, 0}}, to = {{-0.5, 0.2 - way, 0}, {0.5, 0.2 - way, 0}};
    const rods::Touch touch = rods::first_touch({from, to, 0.01}, still);
    INFO("way " << way);
    CHECK(touch.time == Approx(0.14 / way).epsilon(1e-2));
    CHECK(touch.normal[1] == Approx(1));
    CHECK(touch.gap_m < 0.01 * 0.06 + 1e-12);
    CHECK(touch.at.a == Approx(0.5));
  }
}

TEST_CASE("sweeps_that_do_not_touch_say_how_near_they_come") {
  const Axis a = {{-1, 1, 0}, {1, 1, 0}}, b = {{0, 0, -1}, {0, 0, 1}};
  const rods::Touch still = rods::first_touch({a, a, 0.1}, {b, b, 0.1});
  CHECK(still.gap_m == Approx(0.8));
  const Axis nearer = {{-1, 0.5, 0}, {1, 0.5, 0}};
  CHECK(rods::first_touch({a, nearer, 0.1}, {b, b, 0.1}).gap_m == Approx(0.3));
}

TEST_CASE("axes_that_meet_have_a_normal_across_both") {
  const Axis x = {{-1, 0, 0}, {1, 0, 0}}, z = {{0, 0, -1}, {0, 0, 1}}, point = {{0, 0, 0}, {0, 0, 0}};
  for (const auto& [a, b] : {std::pair{x, z}, {x, x}, {x, point}, {point, x}, {point, point}}) {
    const rods::Touch touch = rods::first_touch({a, a, 0.1}, {b, b, 0.1});
    CHECK(rods::length(touch.normal) == Approx(1));
    CHECK(std::fabs(rods::dot(touch.normal, rods::difference(a.to, a.from))) < 1e-12);
    CHECK(std::fabs(rods::dot(touch.normal, rods::difference(b.to, b.from))) < 1e-12);
    CHECK(touch.gap_m == Approx(-0.2));
  }
}
