// surface.cpp  Contours are closed, and what is wrong with a surface is said.
#include "baker/creature/surface.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sinew::baker;
using Eigen::Vector3d;

namespace {

const Eigen::AlignedBox3d kBox(Vector3d(-1, -1, -1), Vector3d(1, 1, 1));
constexpr double kCell_m = 0.08;

double ball(const Vector3d& p, const Vector3d& center, double radius) { return (p - center).norm() - radius; }

double torus(const Vector3d& p) { return std::hypot(std::hypot(p.x(), p.y()) - 0.6, p.z()) - 0.25; }

}  // namespace

TEST_CASE("a_surface_that_is_not_a_sphere_is_told_why") {
  Surface sphere = contour([](const Vector3d& p) { return ball(p, Vector3d::Zero(), 0.8); }, kBox, kCell_m);
  CHECK(why_not_a_sphere(sphere) == "");
  CHECK_THAT(why_not_a_sphere(contour(torus, kBox, kCell_m)), Catch::Contains("1 handle"));
  const auto two_balls = [](const Vector3d& p) {
    return std::min(ball(p, {-0.5, 0, 0}, 0.3), ball(p, {0.5, 0, 0}, 0.3));
  };
  CHECK_THAT(why_not_a_sphere(contour(two_balls, kBox, kCell_m)), Catch::Contains("2 pieces"));
  Surface doubled = sphere;
  doubled.triangles.push_back(doubled.triangles[0]);
  CHECK_THAT(why_not_a_sphere(doubled), Catch::Contains("more than two"));
  sphere.triangles.pop_back();
  CHECK_THAT(why_not_a_sphere(sphere), Catch::Contains("open"));
}

TEST_CASE("a_contour_lies_on_its_field_and_faces_outward") {
  const Surface sphere =
      contour([](const Vector3d& p) { return ball(p, Vector3d::Zero(), 0.8); }, kBox, kCell_m);
  double volume = 0;
  for (const auto& t : sphere.triangles)
    volume +=
        sphere.positions[static_cast<size_t>(t[0])].dot(
            sphere.positions[static_cast<size_t>(t[1])].cross(sphere.positions[static_cast<size_t>(t[2])])) /
        6;
  constexpr double kChords = 0.02;  // flat triangles lie inside the sphere
  CHECK(volume == Approx(4.0 / 3 * M_PI * 0.8 * 0.8 * 0.8).epsilon(kChords));
}
