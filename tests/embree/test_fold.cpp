// test_fold.cpp  Valleys, ridges and steps, each of a floor at y = 0 and one more triangle.
#include "adapters/embree/fold.hpp"

#include <limits>

#include "tests/embree/surface_scenes.hpp"

using namespace sinew;
using namespace sinew::test;
using embree::HeldPoint;
using embree::MovingTriangle;

namespace {

constexpr double kRadius_m = 0.1;

// Lies on the floor and slides along x.
HeldPoint sliding(double from_x, double to_x) {
  return {{from_x, kRadius_m, 0}, {to_x, kRadius_m, 0}, kRadius_m, {0, 1, 0}, 0};
}

// From the floor's edge at x = 0 on, so steep; it shows its upper side.
MovingTriangle slope(double rise_rad, const Vector& move = {}) {
  const double x = std::cos(rise_rad), y = std::sin(rise_rad);
  return {{{Vector{0, 0, -1}, {0, 0, 1}, {x, y, 0}}}, {move, move, move}};
}

}  // namespace

TEST_CASE("what_has_no_area_no_number_or_shows_its_back_is_no_fold") {
  const HeldPoint slides = sliding(-0.2, 0.1);
  MovingTriangle flat = slope(1);
  flat.start.corners[2] = {0, 0, 0};
  CHECK_FALSE(embree::touch_in_fold(slides, flat, false));
  MovingTriangle back = slope(1);
  std::swap(back.start.corners[0], back.start.corners[1]);
  CHECK_FALSE(embree::touch_in_fold(slides, back, false));
  CHECK(embree::touch_in_fold(slides, back, true));  // a sheet has no back
  MovingTriangle none = slope(1);
  none.start.corners[1][2] = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(embree::touch_in_fold(slides, none, true));
}

TEST_CASE("a_point_that_slides_along_a_floor_is_held_by_the_slope_that_it_comes_to") {
  for (const double rise : {0.2, 0.8, 1.5}) {
    const auto touch = embree::touch_in_fold(sliding(-0.2, 0.15), slope(rise), false);
    REQUIRE(touch);
    const Vector normal = {-std::sin(rise), std::cos(rise), 0};
    for (size_t k = 0; k < 3; ++k) CHECK(touch->normal[k] == Approx(normal[k]).margin(1e-12));
    CHECK(touch->gap_m == Approx(0.2 * std::sin(rise) + kRadius_m * std::cos(rise) - kRadius_m));
  }
}

TEST_CASE("ridges_floors_and_slopes_out_of_reach_hold_nothing") {
  CHECK_FALSE(embree::touch_in_fold(sliding(-0.2, 0.15), slope(-0.5), false));
  CHECK_FALSE(embree::touch_in_fold(sliding(-0.2, 0.15), slope(0), false));
  CHECK_FALSE(embree::touch_in_fold(sliding(-0.4, -0.2), slope(1), false));
  // What falls away behind it: its plane, not it, is over the floor.
  CHECK_FALSE(embree::touch_in_fold(sliding(-0.01, -0.5), slope(-0.2), false));
  // It began beyond that slope's plane.
  CHECK_FALSE(embree::touch_in_fold(sliding(0.1, 0.2), slope(1), false));
}

TEST_CASE("a_face_that_is_not_reached_yet_is_not_found_in_penetration") {
  MovingTriangle above = slope(0.2);
  const Vector up = rods::scaled(0.05, above.start.corners[2]);
  for (const size_t k : {0, 1}) above.start.corners[k] = rods::sum(above.start.corners[k], up);
  // Its plane is 0.098 from the point, its edge 0.1025.
  const auto touch = embree::touch_in_fold(sliding(0, 0.15), above, false);
  REQUIRE(touch);
  CHECK(touch->gap_m == 0);
}

TEST_CASE("a_slope_that_comes_holds_what_lies_still") {
  CHECK(embree::touch_in_fold(sliding(-0.2, -0.2), slope(1, {-0.2, 0, 0}), false));
  CHECK_FALSE(embree::touch_in_fold(sliding(-0.2, 0.1), slope(1, {0.3, 0, 0}), false));
}
