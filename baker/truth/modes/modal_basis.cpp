// modal_basis.cpp  A region's lowest modes, from the cage's eigenproblem, as its control nodes see them.
#include "baker/truth/modes/modal_basis.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/truth/modes/body_parts.hpp"
#include "baker/truth/modes/load_weights.hpp"
#include "baker/truth/numerics/modes.hpp"
#include "baker/truth/numerics/sparse_cholesky.hpp"

namespace sinew::baker {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A mode this high answers within a tick of 60 Hz and hardly at all; but a stiff region keeps its first few.
constexpr double kHighest_rad_per_s = 2 * M_PI * 30;
constexpr size_t kFewest = 6;
constexpr int kMostShared = 96;        // modes of a body that several regions take theirs from
constexpr double kSlowest = 1e-12;     // rad/s squared
constexpr double kMostDamping = 0.95;  // of a mode: the correction's budget needs modes that swing

// A body and its lowest modes; all that its regions show is of these.
struct Body {
  std::vector<int> cage_node;
  const FemLinear& linear;
  VectorXd mass;  // a node
  Eigenmodes modes;
  MatrixXd shape, turn;  // (3 cage nodes, modes), zero where the body is not; see warping_turn
  SparseCholesky stiffness;
};

// Displacements of the body, a column each, at every node of the cage; zero where the body is not.
MatrixXd in_cage(const Body& body, const MatrixXd& columns, const Cage& cage) {
  MatrixXd out = MatrixXd::Zero(row_of(cage.nodes.size()), columns.cols());
  for (size_t i = 0; i < body.cage_node.size(); ++i)
    out.middleRows<3>(row_of(static_cast<size_t>(body.cage_node[i]))) = columns.middleRows<3>(row_of(i));
  return out;
}

struct Tetrahedron {
  double volume;                         // sixfold
  Eigen::Matrix<double, 3, 4> gradient;  // of each corner's share
};

Tetrahedron tetrahedron_of(const Cage& cage, const std::array<int, 4>& corners) {
  Eigen::Matrix3d edges;
  for (size_t a = 1; a < 4; ++a)
    edges.col(static_cast<Index>(a) - 1) =
        cage.nodes[static_cast<size_t>(corners[a])] - cage.nodes[static_cast<size_t>(corners[0])];
  Tetrahedron out{edges.determinant(), {}};
  out.gradient.rightCols<3>() = edges.inverse().transpose();
  out.gradient.col(0) = -out.gradient.rightCols<3>().rowwise().sum();
  return out;
}

Eigen::Matrix3d cross_matrix(const Vector3& v) {
  return Eigen::Matrix3d{{0, -v.z(), v.y()}, {v.z(), 0, -v.x()}, {-v.y(), v.x(), 0}};
}

// How the flesh of a body turns for small q.
struct Turning {
  MatrixXd turn;   // (3 cage nodes, modes): half the curl, in the mean, by volume, of the tetrahedra around
  VectorXd share;  // of each mode's gradient (squared, over the body) what is rotation: 1 a rigid turn, 1/2 a
                   // simple shear, 0 a stretch
};

Turning turning_in_cage(const MatrixXd& shape, const std::vector<int>& cage_node, const Cage& cage) {
  std::vector<bool> in_body(cage.nodes.size(), false);
  for (const int node : cage_node) in_body[static_cast<size_t>(node)] = true;
  MatrixXd turn = MatrixXd::Zero(shape.rows(), shape.cols());
  VectorXd volume = VectorXd::Zero(static_cast<Index>(cage.nodes.size()));
  VectorXd rotation = VectorXd::Zero(shape.cols()), gradient = rotation;
  for (const auto& corners : cage.tetrahedra) {
    if (std::none_of(corners.begin(), corners.end(), [&](int n) { return in_body[static_cast<size_t>(n)]; }))
      continue;
    const Tetrahedron t = tetrahedron_of(cage, corners);
    MatrixXd curl = MatrixXd::Zero(3, shape.cols());
    MatrixXd along[3];
    for (MatrixXd& derivative : along) derivative = MatrixXd::Zero(3, shape.cols());
    for (size_t a = 0; a < 4; ++a) {
      const Vector3 slope = t.gradient.col(static_cast<Index>(a));
      curl += cross_matrix(slope) * shape.middleRows<3>(3 * corners[a]);
      for (Index axis = 0; axis < 3; ++axis) along[axis] += slope[axis] * shape.middleRows<3>(3 * corners[a]);
    }
    rotation += 0.5 * t.volume * curl.colwise().squaredNorm().transpose();
    for (const MatrixXd& derivative : along)
      gradient += t.volume * derivative.colwise().squaredNorm().transpose();
    for (const int n : corners) turn.middleRows<3>(3 * n) += 0.5 * t.volume * curl, volume[n] += t.volume;
  }
  for (Index n = 0; n < volume.size(); ++n)
    if (volume[n] > 0) turn.middleRows<3>(3 * n) /= volume[n];
  return {turn, rotation.cwiseQuotient(gradient)};
}

// The part of the turn that bends a mode's path. A cantilever bent evenly leaves its straight path by 2/3 of
// its tip's turn, and kTurnShare validated best; a layer in simple shear turns as much as it stretches, and
// does not leave its path.
MatrixXd warping_turn(const Turning& turning) {
  const VectorXd share = kTurnShare * (2 * turning.share.array() - 1).max(0).matrix();
  return turning.turn * share.asDiagonal();
}

// In the tetrahedron that has it, or at the nearest edge of one: shares are not below 0.
Cage::Place nearest_place(const Vector3& at, const Cage& cage) {
  Cage::Place best;
  double deepest = -std::numeric_limits<double>::infinity();
  for (size_t e = 0; e < cage.tetrahedra.size(); ++e) {
    const auto& corners = cage.tetrahedra[e];
    if ((cage.nodes[static_cast<size_t>(corners[0])] - at).squaredNorm() > 1e4 * cage.cell_m * cage.cell_m)
      continue;
    const Eigen::Matrix<double, 3, 4> slopes = tetrahedron_of(cage, corners).gradient;
    Eigen::Vector4d shares = slopes.transpose() * (at - cage.nodes[static_cast<size_t>(corners[0])]);
    shares[0] += 1;
    if (shares.minCoeff() <= deepest) continue;
    deepest = shares.minCoeff();
    shares = shares.cwiseMax(0) / shares.cwiseMax(0).sum();
    best.tetrahedron = static_cast<int>(e);
    std::copy_n(shares.data(), 4, best.weight.begin());
  }
  return best;
}

Cage::Place place_of(const ControlNode& node, const Cage& cage) {
  if (node.corner.is_corner) return nearest_place(node.position, cage);
  return cage.surface[static_cast<size_t>(node.vertex)];
}

// (3 cage nodes, modes) -> (3 control nodes of the region, modes).
MatrixXd at_control_nodes(const MatrixXd& in_cage, const TissueLayout& layout, const Region& region,
                          const Cage& cage) {
  MatrixXd out = MatrixXd::Zero(3 * region.node_count, in_cage.cols());
  for (int n = 0; n < region.node_count; ++n) {
    const ControlNode& node = layout.nodes[static_cast<size_t>(region.first_node + n)];
    const Cage::Place place = place_of(node, cage);
    const auto& corners = cage.tetrahedra[static_cast<size_t>(place.tetrahedron)];
    for (size_t a = 0; a < 4; ++a)
      out.middleRows<3>(3 * n) += place.weight[a] * in_cage.middleRows<3>(3 * corners[a]);
  }
  return out;
}

Body solve_body(const FemLinear& linear, const std::vector<int>& cage_node, int count, const Cage& cage) {
  Body body{{}, linear, {}, lowest_modes(linear.stiffness, linear.mass, count), {}, {}, {}};
  body.mass = linear.mass(Eigen::seq(0, Eigen::last, 3));
  for (const int node : linear.nodes) body.cage_node.push_back(cage_node[static_cast<size_t>(node)]);
  body.shape = in_cage(body, body.modes.shape, cage);
  body.turn = warping_turn(turning_in_cage(body.shape, body.cage_node, cage));
  body.stiffness.analyze(linear.stiffness);
  if (!body.stiffness.factor(linear.stiffness))
    throw std::runtime_error("modal basis: no constrained node holds the soft tissue in place");
  return body;
}

struct Mode {
  double rad_per_s, damping_ratio;
  VectorXd shape, turn;
  Eigen::RowVectorXd force;
  double swings;  // how far the region goes in it under loads of all kinds, s^2
};

// What a region gathers from the bodies it has a share of.
struct Gathered {
  std::vector<Mode> modes;
  MatrixXd compliance;  // (3 nodes, 3 nodes), s^2: the answer to a steady felt acceleration
  double first_rad_per_s = 0, first_damping_ratio = 0;
};

// A region in the layout that is baked, and in the finest, whose nodes say how large a mode is.
struct Seen {
  const TissueLayout &layout, &finest;
  size_t index;
  const Region& region() const { return layout.regions[index]; }
};

// Inertial forces on the body (3 body nodes, 3 control nodes) of felt accelerations at the control nodes.
MatrixXd loads_from_nodes(const Body& body, const MatrixXd& shape, const Seen& seen, const Cage& cage) {
  const Region& region = seen.region();
  LoadPlaces nodes, flesh;
  for (int n = 0; n < region.node_count; ++n) {
    const ControlNode& node = seen.layout.nodes[static_cast<size_t>(region.first_node + n)];
    nodes.push_back(node.position, node.skin);
  }
  for (const int node : body.cage_node)
    flesh.push_back(cage.nodes[static_cast<size_t>(node)], cage.skin[static_cast<size_t>(node)]);
  const MatrixXd answers = body.modes.squared_rad_per_s.cwiseMax(kSlowest).cwiseInverse().asDiagonal();
  nodes.answers = shape * answers;
  flesh.answers = body.modes.shape * answers;
  const MatrixXd weights = load_weights(nodes, flesh);
  MatrixXd loads = MatrixXd::Zero(row_of(flesh.size()), 3 * region.node_count);
  for (Index c = 0; c < weights.rows(); ++c)
    for (Index n = 0; n < weights.cols(); ++n)
      loads.block<3, 3>(3 * c, 3 * n).diagonal().setConstant(weights(c, n) * body.mass[c]);
  return loads;
}

VectorXd sizes_of(const MatrixXd& everywhere, const Seen& seen, const Cage& cage) {
  const Region& region = seen.finest.regions[seen.index];
  const MatrixXd shape = at_control_nodes(everywhere, seen.finest, region, cage);
  return shape.colwise().norm().transpose() / std::sqrt(static_cast<double>(region.node_count));
}

double damping_of(const FemLinear& body, double rad_per_s) {
  const double ratio = 0.5 * (body.rayleigh_mass_per_s / rad_per_s + body.rayleigh_stiffness_s * rad_per_s);
  return std::min(ratio, kMostDamping);
}

void append_modes(const Body& body, const MatrixXd& shape, const MatrixXd& loads, const Seen& seen,
                  const Cage& cage, std::vector<Mode>* modes) {
  const VectorXd sizes = sizes_of(body.shape, seen, cage);
  const MatrixXd turn = at_control_nodes(body.turn, seen.layout, seen.region(), cage);
  const MatrixXd force = body.modes.shape.transpose() * loads;
  for (Index k = 0; k < shape.cols(); ++k) {
    const double squared = body.modes.squared_rad_per_s[k], w = std::sqrt(squared), size = sizes[k];
    if (!(w > 0) || !(size > 0)) continue;
    modes->push_back({w, damping_of(body.linear, w), shape.col(k) / size, turn.col(k) / size,
                      force.row(k) * size, size / squared});
  }
}

void gather(const Body& body, const Seen& seen, const Cage& cage, Gathered* to) {
  const TissueLayout& layout = seen.layout;
  const Region& region = seen.region();
  const MatrixXd shape = at_control_nodes(body.shape, layout, region, cage);
  const MatrixXd loads = loads_from_nodes(body, shape, seen, cage);
  append_modes(body, shape, loads, seen, cage, &to->modes);
  to->compliance += at_control_nodes(in_cage(body, body.stiffness.solve(loads), cage), layout, region, cage);
}

// Of the region with all else held still.
void take_first(const FemLinear& body, const std::vector<size_t>& nodes, Gathered* to) {
  const double first = first_rad_per_s(body, nodes);
  if (to->first_rad_per_s > 0 && to->first_rad_per_s <= first) return;
  to->first_rad_per_s = first;
  to->first_damping_ratio = damping_of(body, first);
}

// Modes in which other regions swing and this one hardly does are not worth a tick's time.
void drop_still_modes(std::vector<Mode>* modes) {
  constexpr double kHardly = 1e-3;
  const auto size = [](const Mode& mode) { return mode.swings * mode.rad_per_s * mode.rad_per_s; };
  double most = 0;
  for (const Mode& mode : *modes) most = std::max(most, size(mode));
  std::erase_if(*modes, [&](const Mode& mode) { return size(mode) < kHardly * most; });
}

size_t kept_modes(const std::vector<Mode>& ascending, int count) {
  const auto high = std::find_if(ascending.begin(), ascending.end(),
                                 [](const Mode& mode) { return mode.rad_per_s > kHighest_rad_per_s; });
  const auto below = static_cast<size_t>(high - ascending.begin());
  return std::min({ascending.size(), static_cast<size_t>(count), std::max(below, kFewest)});
}

// Where the region is held: the node that goes least far.
int stillest_node(const std::vector<Mode>& modes, int nodes) {
  VectorXd far = VectorXd::Zero(nodes);
  for (const Mode& mode : modes)
    for (Index n = 0; n < nodes; ++n) far[n] += (mode.swings * mode.shape.segment<3>(3 * n)).squaredNorm();
  Index least = 0;
  if (nodes > 0) far.minCoeff(&least);
  return static_cast<int>(least);
}

// intensity scales what is answered to a load, and so every displacement.
ModalBasis basis_of(Gathered gathered, int nodes, int count, double intensity) {
  std::vector<Mode>& modes = gathered.modes;
  drop_still_modes(&modes);
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return a.rad_per_s < b.rad_per_s; });
  const auto kept = static_cast<Index>(kept_modes(modes, count));
  ModalBasis basis{VectorXd(kept),
                   VectorXd(kept),
                   MatrixXd(3 * nodes, kept),
                   MatrixXd(3 * nodes, kept),
                   MatrixXd(kept, 3 * nodes),
                   std::move(gathered.compliance)};
  for (Index k = 0; k < kept; ++k) {
    const Mode& mode = modes[static_cast<size_t>(k)];
    basis.rad_per_s[k] = mode.rad_per_s;
    basis.damping_ratio[k] = mode.damping_ratio;
    basis.shape.col(k) = mode.shape;
    basis.turn.col(k) = mode.turn;
    basis.force.row(k) = mode.force;
    basis.rest -= mode.shape * mode.force / (mode.rad_per_s * mode.rad_per_s);
  }
  if (kept > 0) {
    const Mode& next = modes[std::min(modes.size() - 1, static_cast<size_t>(kept))];
    basis.rest_rad_per_s = next.rad_per_s;
    basis.rest_damping_ratio = next.damping_ratio;
  }
  basis.anchor_node = stillest_node(modes, nodes);
  basis.first_rad_per_s = gathered.first_rad_per_s;
  basis.first_damping_ratio = gathered.first_damping_ratio;
  basis.force *= intensity;
  basis.rest *= intensity;
  return basis;
}

}  // namespace

std::vector<ModalBasis> modal_bases(const TissueLayout& layout, const Cage& cage,
                                    const std::vector<FemLinear>& bodies, const std::vector<int>& cage_node,
                                    int count, const TissueLayout* finest) {
  if (count < 1) throw BadInput("modal basis: " + std::to_string(count) + " modes: ask for 1 or more");
  std::vector<Gathered> gathered;
  for (const Region& region : layout.regions)
    gathered.push_back({{}, MatrixXd::Zero(3 * region.node_count, 3 * region.node_count)});
  const TissueLayout& of = finest != nullptr ? *finest : layout;
  for (const FemLinear& linear : bodies) {
    const auto parts = split_by_region(linear, of, cage, cage_node);
    if (parts.empty()) continue;
    const int shared = std::min(kMostShared / count, static_cast<int>(parts.size()));
    Body body = solve_body(linear, cage_node, count * std::max(1, shared) + 1, cage);
    for (const auto& [region, nodes] : parts) {
      const auto index = static_cast<size_t>(region);
      gather(body, {layout, of, index}, cage, &gathered[index]);
      take_first(linear, nodes, &gathered[index]);
    }
  }
  std::vector<ModalBasis> bases;
  for (size_t r = 0; r < layout.regions.size(); ++r)
    bases.push_back(
        basis_of(std::move(gathered[r]), layout.regions[r].node_count, count, layout.regions[r].intensity));
  return bases;
}

}  // namespace sinew::baker
