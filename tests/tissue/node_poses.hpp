// node_poses.hpp  Node poses written by hand.
#pragma once
#include <Eigen/Geometry>

#include "tissue/frames/node_pose.hpp"

namespace sinew::test {

inline tissue::NodePose node_pose(const Eigen::Matrix3d& rotation,
                                  const Eigen::Vector3d& place_m = {0, 0, 0}) {
  tissue::NodePose pose{};
  Eigen::Map<Eigen::Vector3f>(pose.place_m) = place_m.cast<float>();
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(pose.rotation) = rotation.cast<float>();
  return pose;
}

// About an axis that is none of the coordinates', after a constant turn, so that no axis is special.
inline Eigen::Matrix3d turned(double angle_rad) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -0.5).normalized();
  return (Eigen::AngleAxisd(0.8, Eigen::Vector3d(0.3, 1, 0.2).normalized()) *
          Eigen::AngleAxisd(angle_rad, axis))
      .toRotationMatrix();
}

}  // namespace sinew::test
