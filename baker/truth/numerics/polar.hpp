// polar.hpp  The rotation nearest to a 3x3 matrix.
#pragma once
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace sinew::baker {

// By singular values: right for every matrix, also flat and mirrored ones. Microseconds.
inline Eigen::Matrix3d nearest_rotation_by_svd(const Eigen::Matrix3d& a) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

// Newton's iteration q <- (q + q^-T) / 2 (Higham 1986); singular values where it would not hold.
inline Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& a) {
  constexpr double kFlat = 1e-3, kConverged = 1e-15;
  const double size = a.norm() / std::sqrt(3.0), volume = a.determinant();
  if (!(volume > kFlat * size * size * size)) return nearest_rotation_by_svd(a);
  Eigen::Matrix3d q = a / size;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d next = 0.5 * (q + q.inverse().transpose());
    const double change = (next - q).squaredNorm();
    q = next;
    if (change < kConverged * kConverged * 9) break;
  }
  return q;
}

}  // namespace sinew::baker
