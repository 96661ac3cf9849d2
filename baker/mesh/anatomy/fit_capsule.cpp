// fit_capsule.cpp  see fit_capsule.hpp.
#include "baker/mesh/anatomy/fit_capsule.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sinew::baker {
namespace {

using Eigen::Vector3d;

constexpr double kLeftOut = 0.02, kMiddleFrom = 0.2, kRadius = 0.5;

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<size_t>(at)];
}

Vector3d longest_extent(std::span<const Vector3d> points, const Vector3d& middle) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) spread += (p - middle) * (p - middle).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
}

}  // namespace

FittedCapsule fit_capsule(std::span<const Vector3d> points, const Vector3d& along) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : points) middle += p / static_cast<double>(points.size());
  const Vector3d axis = along.norm() > 1e-9 ? Vector3d(along.normalized()) : longest_extent(points, middle);
  std::vector<double> heights, distances;
  for (const Vector3d& p : points) heights.push_back((p - middle).dot(axis));
  const double low = quantile(heights, kLeftOut), high = quantile(heights, 1 - kLeftOut);
  const double margin = kMiddleFrom * (high - low);
  for (size_t i = 0; i < points.size(); ++i) {
    if (heights[i] < low + margin || heights[i] > high - margin) continue;
    distances.push_back((points[i] - middle - heights[i] * axis).norm());
  }
  if (distances.empty()) distances.push_back((high - low) / 2);
  const double radius = quantile(distances, kRadius);
  const double half = std::max(0.0, (high - low) / 2 - radius), centre = (low + high) / 2;
  return {middle + (centre - half) * axis, middle + (centre + half) * axis, radius};
}

}  // namespace sinew::baker
