// carry.cpp  The interpolation's cardinal functions.
#include "baker/mesh/graph/carry.hpp"

#include <Eigen/QR>

namespace sinew::baker {
namespace {

// Distances to all centres, then 1 x y z in the part's own units.
Eigen::RowVectorXd basis(const Vector3& place, const std::vector<Vector3>& centres) {
  const auto count = static_cast<Eigen::Index>(centres.size());
  Eigen::RowVectorXd row(count + 4);
  for (Eigen::Index i = 0; i < count; ++i) row[i] = (place - centres[static_cast<size_t>(i)]).norm();
  row.tail<4>() << 1, place.x(), place.y(), place.z();
  return row;
}

}  // namespace

std::vector<std::vector<double>> carry_weights(const std::vector<Vector3>& nodes,
                                               const std::vector<Vector3>& anchors,
                                               const std::vector<Vector3>& places) {
  Vector3 center = Vector3::Zero();
  for (const Vector3& node : nodes) center += node / static_cast<double>(nodes.size());
  double radius = 0;
  for (const Vector3& node : nodes) radius = std::max(radius, (node - center).norm());
  const auto scaled = [&](const Vector3& place) -> Vector3 { return (place - center) / radius; };

  std::vector<Vector3> centres;
  for (const Vector3& node : nodes) centres.push_back(scaled(node));
  for (const Vector3& anchor : anchors) centres.push_back(scaled(anchor));
  const auto count = static_cast<Eigen::Index>(centres.size()),
             wanted = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(count + 4, count + 4);
  for (Eigen::Index i = 0; i < count; ++i) system.row(i) = basis(centres[static_cast<size_t>(i)], centres);
  system.bottomLeftCorner(4, count) = system.topRightCorner(count, 4).transpose();

  // Flat parts leave the linear terms undetermined: the solution of least norm is the one that ignores them.
  const Eigen::MatrixXd cardinal =
      system.completeOrthogonalDecomposition().solve(Eigen::MatrixXd::Identity(count + 4, wanted));
  std::vector<std::vector<double>> weights(nodes.size(), std::vector<double>(places.size()));
  for (size_t p = 0; p < places.size(); ++p) {
    const Eigen::RowVectorXd row = basis(scaled(places[p]), centres) * cardinal;
    for (size_t n = 0; n < nodes.size(); ++n) weights[n][p] = row[static_cast<Eigen::Index>(n)];
  }
  return weights;
}

}  // namespace sinew::baker
