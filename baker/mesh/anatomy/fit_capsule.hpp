// fit_capsule.hpp  The capsule that a bone's flesh is taken for.
#pragma once
#include <Eigen/Core>
#include <span>

namespace sinew::baker {

struct FittedCapsule {
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  // the same: a sphere
  double radius_m = 0;
};

// About the points' middle, along a direction of any length, or, where that is zero, along where they extend
// most. It reaches from their 2nd to their 98th hundredth along it; its radius is the median distance from
// the axis of those in the middle three fifths. At least 4 points, not all in one place along and across.
FittedCapsule fit_capsule(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& along);

}  // namespace sinew::baker
