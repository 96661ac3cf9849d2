// camera.hpp  Where the picture is taken from.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

namespace sinew::render {

struct Camera {
  Eigen::Vector3f eye, target;
  float vertical_fov_deg = 26;
};

struct View {
  float yaw_deg = 32;    // 0: from the front (+Z), 90: from +X
  float pitch_deg = 11;  // above the horizon
  float margin = 1.14f;  // 1: the box touches the edges
  float vertical_fov_deg = 26;
};

// Stands as near as it can with all the points in view of a picture of this width : height, and centred.
Camera camera_around(std::span<const Eigen::Vector3f> points, float aspect, const View& view = {});
Camera camera_around(const Eigen::AlignedBox3f& box, float aspect, const View& view = {});

// Unit directions of rays, from the camera through the picture's plane.
struct Rays {
  Eigen::Vector3f origin, forward, right, up;  // right and up are scaled to half the picture
  Rays(const Camera& camera, float aspect);
  // x and y from -1 (left, bottom) to 1.
  Eigen::Vector3f direction(float x, float y) const { return (forward + x * right + y * up).normalized(); }
  // Where a point before the camera is seen, from the top left corner of a picture of this size.
  Eigen::Vector2f pixel(const Eigen::Vector3f& point, int width, int height) const;
};

}  // namespace sinew::render
