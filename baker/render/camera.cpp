// camera.cpp  see camera.hpp.
#include "baker/render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::render {
namespace {

constexpr float kRadians = 0.017453293f;

float half_height(float vertical_fov_deg) { return std::tan(0.5f * vertical_fov_deg * kRadians); }

}  // namespace

Rays::Rays(const Camera& camera, float aspect)
    : origin(camera.eye), forward((camera.target - camera.eye).normalized()) {
  const float half = half_height(camera.vertical_fov_deg);
  right = forward.cross(Eigen::Vector3f::UnitY()).normalized();
  up = right.cross(forward) * half;
  right *= half * aspect;
}

Eigen::Vector2f Rays::pixel(const Eigen::Vector3f& point, int width, int height) const {
  const Eigen::Vector3f seen = (point - origin) / (point - origin).dot(forward);
  const float x = seen.dot(right) / right.squaredNorm(), y = seen.dot(up) / up.squaredNorm();
  return {0.5f * (1 + x) * static_cast<float>(width), 0.5f * (1 - y) * static_cast<float>(height)};
}

namespace {

struct Axes {
  Eigen::Vector3f right, up, back;
  explicit Axes(const View& view) {
    const float yaw = view.yaw_deg * kRadians, pitch = view.pitch_deg * kRadians;
    back = {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
    right = (-back).cross(Eigen::Vector3f::UnitY()).normalized();
    up = right.cross(-back);
  }
};

// The nearest eye whose picture holds all points along one axis of the picture: how far right (or up) of the
// origin, and how far back. Each edge of the picture is a line that no point may cross, slope * (back -
// p.back) >= +-(p.side - side).
Eigen::Vector2f eye_along(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& side,
                          const Eigen::Vector3f& back, float slope) {
  float high = -std::numeric_limits<float>::infinity(), low = high;
  for (const Eigen::Vector3f& p : points) {
    high = std::max(high, slope * p.dot(back) + p.dot(side));
    low = std::max(low, slope * p.dot(back) - p.dot(side));
  }
  return {0.5f * (high - low), 0.5f * (high + low) / slope};
}

}  // namespace

Camera camera_around(std::span<const Eigen::Vector3f> points, float aspect, const View& view) {
  if (points.empty())
    return camera_around(Eigen::AlignedBox3f(Eigen::Vector3f(-1, 0, -1), Eigen::Vector3f(1, 2, 1)), aspect,
                         view);
  const Axes axes(view);
  const float slope = half_height(view.vertical_fov_deg) / view.margin;
  const Eigen::Vector2f across = eye_along(points, axes.right, axes.back, slope * aspect);
  const Eigen::Vector2f upright = eye_along(points, axes.up, axes.back, slope);
  const float distance = std::max(across.y(), upright.y());
  const Eigen::Vector3f eye = across.x() * axes.right + upright.x() * axes.up + distance * axes.back;
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points) box.extend(p);
  const float ahead = std::max((eye - box.center()).dot(axes.back), 1e-6f);
  return {eye, eye - ahead * axes.back, view.vertical_fov_deg};
}

Camera camera_around(const Eigen::AlignedBox3f& box, float aspect, const View& view) {
  Eigen::Vector3f corners[8];
  for (int i = 0; i < 8; ++i) corners[i] = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
  return camera_around(corners, aspect, view);
}

}  // namespace sinew::render
