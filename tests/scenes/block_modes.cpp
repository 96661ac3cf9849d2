// block_modes.cpp  The soft block's modes: a few shapes in closed form instead of an eigenproblem.
#include "tests/scenes/block_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::scenes {
namespace {

using baker::ModalBasis;
using baker::Vector3;

struct BlockMode {
  double frequency_hz;
  int axis;
  bool whole;
};
constexpr BlockMode kModes[] = {{3.5, 0, true}, {3.8, 2, true},  {6, 1, true},
                                {9, 0, false},  {9.5, 2, false}, {12, 1, false}};
constexpr double kDampingRatio = 0.1, kRest_s2 = 2e-5, kRest_hz = 15;

// A cantilever's first bend, and one that turns over on the way up.
double profile(double y_m, bool whole) {
  const double t = std::max(0.0, (y_m - kBlockSoftFrom_m) / (kBlockHeight_m - kBlockSoftFrom_m));
  return t * t * (3 - t) / 2 * (whole ? 1 : std::cos(std::numbers::pi * t));
}

double slope(double y_m, bool whole) {
  constexpr double kStep_m = 1e-6;
  return (profile(y_m + kStep_m, whole) - profile(y_m - kStep_m, whole)) / (2 * kStep_m);
}

// Half the curl of profile(y) along the axis.
Vector3 half_curl(double slope, int axis) {
  return axis == 0 ? Vector3(0, 0, -slope / 2) : axis == 2 ? Vector3(slope / 2, 0, 0) : Vector3(0, 0, 0);
}

// Root mean square over the region's nodes.
double size_of(const BlockMode& mode, const baker::TissueLayout& layout, const baker::Region& region) {
  double squares = 0;
  for (int n = region.first_node; n < region.first_node + region.node_count; ++n)
    squares += std::pow(profile(layout.nodes[static_cast<size_t>(n)].position.y(), mode.whole), 2);
  return std::sqrt(squares / region.node_count);
}

ModalBasis region_modes(const baker::TissueLayout& layout, const baker::Region& region,
                        const baker::TissueLayout& finest, const baker::Region& of) {
  const auto count = static_cast<Eigen::Index>(std::size(kModes));
  const Eigen::Index rows = 3 * region.node_count;
  ModalBasis basis{Eigen::VectorXd(count),
                   Eigen::VectorXd::Constant(count, kDampingRatio),
                   Eigen::MatrixXd::Zero(rows, count),
                   Eigen::MatrixXd::Zero(rows, count),
                   Eigen::MatrixXd(count, rows),
                   kRest_s2 * Eigen::MatrixXd::Identity(rows, rows),
                   2 * std::numbers::pi * kRest_hz,
                   kDampingRatio};
  basis.first_rad_per_s = 2 * std::numbers::pi * kModes[0].frequency_hz;
  basis.first_damping_ratio = kDampingRatio;
  for (Eigen::Index k = 0; k < count; ++k) {
    const BlockMode& mode = kModes[k];
    basis.rad_per_s[k] = 2 * std::numbers::pi * mode.frequency_hz;
    for (int n = 0; n < region.node_count; ++n) {
      const double y_m = layout.nodes[static_cast<size_t>(region.first_node + n)].position.y();
      basis.shape(3 * n + mode.axis, k) = profile(y_m, mode.whole);
      basis.turn.col(k).segment<3>(3 * n) = half_curl(slope(y_m, mode.whole), mode.axis);
    }
    const double size = size_of(mode, finest, of);
    basis.shape.col(k) /= size;
    basis.turn.col(k) /= size;
    basis.force.row(k) = basis.shape.col(k).transpose() / basis.shape.col(k).squaredNorm();
  }
  return basis;
}

}  // namespace

std::vector<ModalBasis> block_modes(const baker::TissueLayout& layout, const baker::TissueLayout* finest) {
  const baker::TissueLayout& of = finest ? *finest : layout;
  std::vector<ModalBasis> modes;
  for (size_t r = 0; r < layout.regions.size(); ++r)
    modes.push_back(region_modes(layout, layout.regions[r], of, of.regions[r]));
  return modes;
}

}  // namespace sinew::scenes
