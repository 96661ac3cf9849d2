// camera.cpp  see camera.hpp.
#include "perf/frames/camera.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "perf/frames/floor.hpp"
#include "perf/frames/walls.hpp"

namespace sinew::perf {
namespace {

using Eigen::Vector3d;

View look(const Vector3d& eye, const Vector3d& at) {
  const Vector3d back = (eye - at).normalized();
  const Vector3d right = Vector3d::UnitY().cross(back).normalized();
  Eigen::Matrix3d axes;
  axes << right, back.cross(right), back;
  const Eigen::Quaternionf turn(axes.cast<float>());
  View view;
  std::copy_n(eye.data(), 3, view.position_m);
  std::copy_n(turn.coeffs().data(), 4, view.rotation_xyzw);
  return view;
}

Vector3d middle_of(uint32_t instances) {
  const double half_m = side_of_floor_m(instances) / 2;
  return {half_m, 0.5, half_m};
}

Vector3d corner_of(uint32_t instances) {
  const double off_m = 1.5 + 0.05 * side_of_floor_m(instances);
  return {-off_m, 1.7, -off_m};
}

View away(uint32_t instances) {
  const Vector3d eye = corner_of(instances);
  return look(eye, 2 * eye - middle_of(instances));
}

Vector3d at_eye_height(const RootTransform& root) {
  return Eigen::Map<const Vector3d>(root.position_m) + Vector3d(0, 1.2, 0);
}

View across(uint32_t instances, uint32_t second) {
  const uint32_t who = second * 37 % instances;
  return look(at_eye_height(place_on_floor(who, instances)),
              at_eye_height(place_on_floor(instances - 1 - who, instances)));
}

View along_walls(uint32_t instances, uint32_t frame) {
  constexpr double kSpeed_m_s = 0.5;
  const double side_m = side_of_floor_m(instances), way_m = kSpeed_m_s * frame / kFrames_a_second;
  const double x = side_m - std::fabs(std::fmod(way_m, 2 * side_m) - side_m);
  return look({x, 1.7, kWalls_m - 2}, {x, 0.5, side_m});
}

}  // namespace

View overview(uint32_t instances) { return look(corner_of(instances), middle_of(instances)); }

View camera_of(const Scene& scene, uint32_t frame) {
  if (scene.trouble == Trouble::kCuts) return across(scene.instances, frame / kFrames_a_second);
  if (scene.trouble == Trouble::kHidden) return away(scene.instances);
  if (scene.trouble == Trouble::kWalls) return along_walls(scene.instances, frame);
  return overview(scene.instances);
}

}  // namespace sinew::perf
