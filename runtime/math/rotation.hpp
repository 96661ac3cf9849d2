// rotation.hpp  Rotations as quaternions and as rotation vectors, in double.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace sinew::world {

inline Eigen::Quaterniond quaternion(const float xyzw[4]) noexcept {
  return Eigen::Map<const Eigen::Quaternionf>(xyzw).cast<double>().normalized();
}

// Axis times angle on the shorter arc; exact through zero.
inline Eigen::Vector3d logarithm(const Eigen::Quaterniond& q) noexcept {
  constexpr double kNoTurn = 1e-12;
  const double sign = q.w() < 0 ? -1 : 1, sine = q.vec().norm();
  const double scale = sine > kNoTurn ? 2 * std::atan2(sine, sign * q.w()) / sine : 2;
  return q.vec() * (sign * scale);
}

inline Eigen::Quaterniond exponential(const Eigen::Vector3d& turn) noexcept {
  const double angle = turn.norm();
  if (!(angle > 0)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

}  // namespace sinew::world
