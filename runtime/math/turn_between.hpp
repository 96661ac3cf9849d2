// turn_between.hpp  The smallest turn that takes one direction to another.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace sinew::core {

// Lengths do not matter; from or to no direction at all it is no turn, of norm sqrt(1/2). Opposite directions
// have no smallest turn: half a turn about some axis across them. The bits of Eigen's FromTwoVectors in all
// other cases, without the decomposition that each file that calls it would compile.
inline Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
  constexpr double kOpposite = 1e-12;  // a millionth of a radian
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond turn(0, 0, 0, 0);
  if (cosine < kOpposite - 1) {
    turn.vec() = a.unitOrthogonal();
    return turn;
  }
  const double twice_w = std::sqrt((1 + cosine) * 2);
  turn.vec() = a.cross(b) * (1 / twice_w);
  turn.w() = twice_w * 0.5;
  return turn;
}

}  // namespace sinew::core
