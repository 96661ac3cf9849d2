// camera.cpp  The camera holds what it is asked to hold, and no more.
#include <catch2/catch.hpp>
#include <vector>

#include "baker/render/camera.hpp"
#include "tests/baker/render/shapes.hpp"

using namespace sinew::render;

namespace {

// Where a point falls in the picture, -1 .. 1.
Eigen::Vector2f project(const Camera& camera, float aspect, const Eigen::Vector3f& point) {
  const Rays rays(camera, aspect);
  const Eigen::Vector3f to = point - rays.origin;
  const float depth = to.dot(rays.forward);
  return {to.dot(rays.right) / rays.right.squaredNorm() / depth,
          to.dot(rays.up) / rays.up.squaredNorm() / depth};
}

}  // namespace

TEST_CASE("camera_without_points_is_still_a_camera") {
  const Camera camera = camera_around(std::span<const Eigen::Vector3f>(), 1);
  CHECK(camera.eye.allFinite());
  CHECK((camera.eye - camera.target).norm() > 0);
}

TEST_CASE("camera_keeps_every_point_in_view_and_touches_the_margin") {
  const std::vector<Eigen::Vector3f> points =
      sinew::test::sphere({3, 1, -2}, 0.7f, Rgb::Ones(), 12).positions;
  for (const float aspect : {0.6f, 1.0f, 1.8f}) {
    for (const float yaw : {0.0f, 32.0f, 200.0f}) {
      const Camera camera = camera_around(points, aspect, {.yaw_deg = yaw, .margin = 1.25f});
      float reach = 0;
      for (const Eigen::Vector3f& p : points)
        reach = std::max(reach, project(camera, aspect, p).cwiseAbs().maxCoeff());
      CHECK(reach == Approx(1 / 1.25f).epsilon(0.01));
    }
  }
}

TEST_CASE("yaw_zero_looks_from_the_front") {
  const Camera camera = camera_around(
      Eigen::AlignedBox3f(Eigen::Vector3f(-1, 0, -1), Eigen::Vector3f(1, 2, 1)), 1, {.yaw_deg = 0});
  CHECK(camera.eye.z() > 2);
  CHECK(camera.eye.x() == Approx(0).margin(1e-4));
}
