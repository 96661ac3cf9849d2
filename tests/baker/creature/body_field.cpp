// body_field.cpp  The body's field: distances, gradients, unions, cuts.
#include "baker/creature/body_field.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace sinew::baker;
using Eigen::Vector3d;

namespace {

BodyPart ellipsoid(const Vector3d& at, const Vector3d& radii, double blend_m) {
  BodyPart part;
  part.solid.at = at;
  part.solid.radii = radii;
  part.solid.turn_deg = {20, 30, 40};
  part.blend_m = blend_m;
  return part;
}

BodyPart tube(double flat) {
  BodyPart part;
  part.solid.points = {{0, 0.2, 0, 0.1}, {0.1, 0.5, 0, 0.12}, {0.3, 0.7, 0, 0.05}};
  part.solid.flat = flat;
  part.blend_m = 0.05;
  return part;
}

}  // namespace

TEST_CASE("the_gradient_is_that_of_the_distance") {
  const BodyField field({ellipsoid({0, 0, 0}, {0.3, 0.2, 0.25}, 0), tube(1)});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.4, 0.8);
  constexpr double kStep_m = 1e-6, kTolerance = 1e-3;  // cones of a tube meet in slight kinks
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p(coordinate(random), coordinate(random), coordinate(random));
    if (std::abs(field.sample(p).distance) > 0.05) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kStep_m * Vector3d::Unit(axis);
      const double slope =
          (field.sample(p + step).distance - field.sample(p - step).distance) / (2 * kStep_m);
      CHECK(std::abs(slope - field.sample(p).gradient[axis]) < kTolerance);
    }
    ++compared;
  }
  CHECK(compared > 50);
}

TEST_CASE("projection_ends_on_the_surface") {
  const BodyField field({ellipsoid({0, 0, 0}, {0.3, 0.2, 0.25}, 0), tube(0.4)});
  for (double x : {-0.28, -0.1, 0.05, 0.3}) {
    const Vector3d place = field.project({x, 0.1, 0.2});
    CHECK(std::abs(field.sample(place).distance) < 1e-5);
  }
}

TEST_CASE("a_flat_tube_is_thin_along_its_axis") {
  const BodyField field({tube(0.4)});
  const Vector3d middle(0.1, 0.5, 0);
  constexpr double kTolerance_m = 0.003;  // distances are of first order
  CHECK(field.sample(middle + Vector3d(0, 0, 0.4 * 0.12)).distance == Approx(0).margin(kTolerance_m));
  CHECK(field.sample(middle + Vector3d(0, 0, 0.4 * 0.12 + 0.01)).distance ==
        Approx(0.01).margin(kTolerance_m));
}

TEST_CASE("a_carved_part_is_taken_away_and_a_blend_fills_the_crease") {
  BodyPart hole = ellipsoid({0.3, 0, 0}, {0.1, 0.1, 0.1}, 0.02);
  hole.carve = true;
  const BodyPart base = ellipsoid({0, 0, 0}, {0.3, 0.3, 0.3}, 0);
  CHECK(BodyField({base, hole}).sample({0.28, 0, 0}).distance > 0);
  const BodyPart sharp = ellipsoid({0.4, 0, 0}, {0.2, 0.2, 0.2}, 0),
                 smooth = ellipsoid({0.4, 0, 0}, {0.2, 0.2, 0.2}, 0.1);
  const Vector3d crease(0.2625, 0.1452, 0);
  CHECK(BodyField({base, smooth}).sample(crease).distance <
        BodyField({base, sharp}).sample(crease).distance - 0.01);
}
