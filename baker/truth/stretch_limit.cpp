// stretch_limit.cpp  see stretch_limit.hpp.
#include "baker/truth/stretch_limit.hpp"

#include <algorithm>

namespace sinew::baker {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kShortestEdge = 2e-3;  // of the height: two of a thousand lines, as in the audit

// (3 nodes, 3): displacement of the control nodes under a load along x, y and z; the largest node of each
// moves by 1.
MatrixXd answers_to_uniform_loads(const ModalBasis& basis) {
  const Index nodes = basis.shape.rows() / 3;
  const MatrixXd uniform = MatrixXd::Identity(3, 3).replicate(nodes, 1);
  MatrixXd answer = basis.rest * uniform;
  if (basis.rad_per_s.size() > 0)
    answer += basis.shape * basis.rad_per_s.cwiseAbs2().cwiseInverse().asDiagonal() * (basis.force * uniform);
  for (Index axis = 0; axis < 3; ++axis) {
    double most = 0;
    for (Index n = 0; n < nodes; ++n) most = std::max(most, answer.col(axis).segment<3>(3 * n).norm());
    if (most > 0) answer.col(axis) /= most;
  }
  return answer;
}

// Carried to the region's vertices; zero elsewhere. [vertex of the character], a column an axis.
std::vector<Eigen::Matrix3d> carried(const Region& region, const MatrixXd& answers, size_t vertices) {
  std::vector<Eigen::Matrix3d> out(vertices, Eigen::Matrix3d::Zero());
  for (size_t n = 0; n < region.carry.size(); ++n)
    for (size_t v = 0; v < region.vertices.size(); ++v)
      out[static_cast<size_t>(region.vertices[v])] +=
          region.carry[n][v] * answers.middleRows<3>(3 * static_cast<Index>(n));
  return out;
}

// The largest difference of displacement between the ends of an edge over its length.
double largest_strain(const Character& character, const std::vector<Eigen::Matrix3d>& moved,
                      double shortest_m) {
  double most = 0;
  for (const std::array<int, 3>& triangle : character.triangles)
    for (size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<size_t>(triangle[k]), b = static_cast<size_t>(triangle[(k + 1) % 3]);
      const double length_m = (character.positions[a] - character.positions[b]).norm();
      if (length_m < shortest_m) continue;
      most = std::max(most, (moved[a] - moved[b]).colwise().norm().maxCoeff() / length_m);
    }
  return most;
}

double height_of(const Character& character) {
  const auto [low, high] =
      std::ranges::minmax_element(character.positions, {}, [](const Vector3& p) { return p.y(); });
  return high->y() - low->y();
}

}  // namespace

void limit_by_stretch(const Character& character, const std::vector<ModalBasis>& bases,
                      TissueLayout& layout) {
  const double shortest_m = kShortestEdge * height_of(character);
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    Region& region = layout.regions[r];
    if (region.states_limit || !(region.radius_m > 0)) continue;
    const std::vector<Eigen::Matrix3d> moved =
        carried(region, answers_to_uniform_loads(bases[r]), character.positions.size());
    const double strain_per_m = largest_strain(character, moved, shortest_m);
    if (strain_per_m > 0)
      region.max_displacement =
          std::min(region.max_displacement, (kMostStretch - 1) / strain_per_m / region.radius_m);
  }
}

}  // namespace sinew::baker
