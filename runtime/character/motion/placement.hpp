// placement.hpp  From the character's space to where somebody reads.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "character/instance.hpp"

namespace sinew::world {

struct Placement {
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();
  float scale = 1;
  bool moves = false;

  Eigen::Vector3f place(const Eigen::Vector3f& point) const noexcept {
    return moves ? Eigen::Vector3f(scale * (rotation * point) + offset) : point;
  }
  Eigen::Vector3f turn(const Eigen::Vector3f& vector) const noexcept {
    return moves ? Eigen::Vector3f(rotation * vector) : vector;
  }
};

// The root's for Space::kWorld, less the origin; else none.
inline Placement placement_of(const Instance& instance, Space space, const double (&origin_m)[3]) noexcept {
  Placement placement;
  if (space != Space::kWorld) return placement;
  const RootTransform& root = instance.state->motion.root;
  placement.moves = true;
  placement.rotation = Eigen::Map<const Eigen::Quaternionf>(root.rotation_xyzw).toRotationMatrix();
  placement.scale = static_cast<float>(root.scale);
  for (int k = 0; k < 3; ++k)
    placement.offset[k] = static_cast<float>(root.scale * root.position_m[k] - origin_m[k]);
  return placement;
}

}  // namespace sinew::world
