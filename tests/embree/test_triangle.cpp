// test_triangle.cpp  Closest points and first touches, against sampling.
#include "tests/embree/surface_scenes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

embree::Triangle random_triangle(std::mt19937& engine) {
  return {{random_vector(engine, 1), random_vector(engine, 1), random_vector(engine, 1)}};
}

// Least distance over a grid of the triangle: no less than the truth, and no more than a grid step above it.
double sampled_distance(const embree::Triangle& t, const rods::Axis& axis, int steps) {
  double least = 1e30;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const double u = double(i) / steps, v = double(j) / steps;
      const Vector p = embree::weighted(t.corners, {1 - u - v, u, v});
      const Vector q = rods::between(axis.from, axis.to, rods::nearest(axis, p));
      least = std::min(least, rods::length(rods::difference(p, q)));
    }
  }
  return least;
}

}  // namespace

TEST_CASE("triangles_without_area_and_points_on_corners_have_finite_closest_points") {
  const Vector a = {0, 0, 0}, b = {1, 0, 0}, c = {2, 0, 0}, p = {0.5, 1, 0};
  for (const embree::Triangle& t : {embree::Triangle{{a, a, a}}, {{a, b, c}}, {{a, a, b}}}) {
    const embree::OnTriangle on = embree::nearest(t, p);
    CHECK(rods::finite(on.point));
    CHECK(on.weights[0] + on.weights[1] + on.weights[2] == Approx(1));
    CHECK(std::isfinite(embree::nearest(t, rods::Axis{a, p}).distance_m));
    CHECK(std::isfinite(embree::first_touch({{p, p}, {a, a}, 0}, {t, {}}).gap_m));
  }
  CHECK(embree::nearest({{a, b, p}}, b).feature == 1);
}

TEST_CASE("closest_points_of_axis_and_triangle_are_those_that_sampling_finds") {
  std::mt19937 engine(1);
  for (int i = 0; i < 300; ++i) {
    const embree::Triangle t = random_triangle(engine);
    const rods::Axis axis = {random_vector(engine, 1), random_vector(engine, 1)};
    const embree::AxisOnTriangle n = embree::nearest(t, axis);
    const Vector p = rods::between(axis.from, axis.to, n.along);
    CHECK(rods::length(rods::difference(p, n.on.point)) == Approx(n.distance_m).margin(1e-12));
    CHECK(rods::length(rods::difference(embree::weighted(t.corners, n.on.weights), n.on.point)) < 1e-12);
    const double sampled = sampled_distance(t, axis, 100);
    CHECK(n.distance_m <= sampled + 1e-12);
    CHECK(n.distance_m >= sampled - 0.04);  // longest edge 3.5 over a hundred steps
  }
}

TEST_CASE("no_capsule_and_no_triangle_pass_through_each_other_within_a_tick") {
  std::mt19937 engine(2);
  uint32_t passes = 0;
  for (int i = 0; i < 2000; ++i) {
    const embree::MovingTriangle m = {
        random_triangle(engine),
        {random_vector(engine, 1), random_vector(engine, 1), random_vector(engine, 1)}};
    const Vector a = random_vector(engine, 1), b = random_vector(engine, 1);
    const rods::Sweep s = {{a, b}, {random_vector(engine, 1), random_vector(engine, 1)}, 0.01};
    double least = 1e30;
    for (int k = 0; k <= 64; ++k) {
      const double t = k / 64.0;
      embree::Triangle now;
      for (size_t c = 0; c < 3; ++c) now.corners[c] = rods::scaled_sum(t, m.moves[c], m.start.corners[c]);
      const rods::Axis axis = {rods::between(s.start.from, s.end.from, t),
                               rods::between(s.start.to, s.end.to, t)};
      least = std::min(least, embree::nearest(now, axis).distance_m - 0.01);
    }
    const embree::TriangleTouch touch = embree::first_touch(s, m);
    if (least > 0.005) continue;
    ++passes;
    // Advancement may end before a grazing touch; what it found is then nearly as near.
    CHECK(touch.gap_m < std::max(least, 0.0) + 0.01);
  }
  CHECK(passes > 500);
}
