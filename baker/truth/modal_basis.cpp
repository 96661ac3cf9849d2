// modal_basis.cpp  A region's lowest modes, from the cage's eigenproblem, as its control nodes see them.
#include "baker/truth/modal_basis.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/carry.hpp"
#include "baker/truth/body_parts.hpp"
#include "baker/truth/modes.hpp"
#include "baker/truth/sparse_cholesky.hpp"

namespace sinew::baker {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A mode this high answers within a tick of 60 Hz and hardly at all; but a stiff region keeps its first few.
constexpr double kHighest_rad_per_s = 2 * M_PI * 30;
constexpr size_t kFewest = 6;
constexpr double kMostDamping = 0.95;  // of a mode: the correction's budget needs modes that swing

// One body's share of a region.
struct Part {
  std::vector<int> cage_node;
  Eigen::SparseMatrix<double> stiffness;
  Eigenmodes modes;
  VectorXd mass;  // a node
  double rayleigh_mass_per_s = 0, rayleigh_stiffness_s = 0;
};

Part solve_part(const FemLinear& body, const std::vector<size_t>& nodes, const std::vector<int>& cage_node,
                int count) {
  Part part;
  part.rayleigh_mass_per_s = body.rayleigh_mass_per_s;
  part.rayleigh_stiffness_s = body.rayleigh_stiffness_s;
  part.mass.resize(static_cast<Index>(nodes.size()));
  VectorXd mass(row_of(nodes.size()));
  for (size_t i = 0; i < nodes.size(); ++i) {
    part.cage_node.push_back(cage_node[static_cast<size_t>(body.nodes[nodes[i]])]);
    mass.segment<3>(row_of(i)) = body.mass.segment<3>(row_of(nodes[i]));
    part.mass[static_cast<Index>(i)] = body.mass[row_of(nodes[i])];
  }
  part.stiffness = block_of(body.stiffness, nodes);
  part.modes = lowest_modes(part.stiffness, mass, count);
  return part;
}

// At its own first mode and at three times that, where the body's is another region's.
void damp_part(double ratio, Part* part) {
  const double first = std::sqrt(part->modes.squared_rad_per_s[0]);
  part->rayleigh_mass_per_s = 1.5 * ratio * first;
  part->rayleigh_stiffness_s = 0.5 * ratio / first;
}

// Displacements of the part, a column each, at every node of the cage; zero where the part is not.
MatrixXd in_cage(const Part& part, const MatrixXd& columns, const Cage& cage) {
  MatrixXd out = MatrixXd::Zero(row_of(cage.nodes.size()), columns.cols());
  for (size_t i = 0; i < part.cage_node.size(); ++i)
    out.middleRows<3>(row_of(static_cast<size_t>(part.cage_node[i]))) = columns.middleRows<3>(row_of(i));
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

// How the flesh of a part turns for small q.
struct Turning {
  MatrixXd turn;   // (3 cage nodes, modes): half the curl, in the mean, by volume, of the tetrahedra around
  VectorXd share;  // of each mode's gradient (squared, over the part) what is rotation: 1 a rigid turn, 1/2 a
                   // simple shear, 0 a stretch
};

Turning turning_in_cage(const MatrixXd& shape, const Part& part, const Cage& cage) {
  std::vector<bool> in_part(cage.nodes.size(), false);
  for (const int node : part.cage_node) in_part[static_cast<size_t>(node)] = true;
  MatrixXd turn = MatrixXd::Zero(shape.rows(), shape.cols());
  VectorXd volume = VectorXd::Zero(static_cast<Index>(cage.nodes.size()));
  VectorXd rotation = VectorXd::Zero(shape.cols()), gradient = rotation;
  for (const auto& corners : cage.tetrahedra) {
    if (std::none_of(corners.begin(), corners.end(), [&](int n) { return in_part[static_cast<size_t>(n)]; }))
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

// (3 cage nodes, modes) -> (3 control nodes of the region, modes).
MatrixXd at_control_nodes(const MatrixXd& in_cage, const TissueLayout& layout, const Region& region,
                          const Cage& cage) {
  MatrixXd out = MatrixXd::Zero(3 * region.node_count, in_cage.cols());
  for (int n = 0; n < region.node_count; ++n) {
    const ControlNode& node = layout.nodes[static_cast<size_t>(region.first_node + n)];
    const Cage::Place& place = cage.surface[static_cast<size_t>(node.vertex)];
    const auto& corners = cage.tetrahedra[static_cast<size_t>(place.tetrahedron)];
    for (size_t a = 0; a < 4; ++a)
      out.middleRows<3>(3 * n) += place.weight[a] * in_cage.middleRows<3>(3 * corners[a]);
  }
  return out;
}

// Inertial forces on the part (3 part nodes, 3 control nodes) of felt accelerations at the control nodes,
// carried through the flesh.
MatrixXd loads_from_nodes(const Part& part, const TissueLayout& layout, const Region& region,
                          const Cage& cage) {
  std::vector<Vector3> nodes, flesh;
  for (int n = 0; n < region.node_count; ++n)
    nodes.push_back(layout.nodes[static_cast<size_t>(region.first_node + n)].position);
  for (const int node : part.cage_node) flesh.push_back(cage.nodes[static_cast<size_t>(node)]);
  const std::vector<std::vector<double>> carry = carry_weights(nodes, {}, flesh);
  MatrixXd loads = MatrixXd::Zero(row_of(flesh.size()), 3 * region.node_count);
  for (size_t n = 0; n < nodes.size(); ++n)
    for (size_t c = 0; c < flesh.size(); ++c)
      loads.block<3, 3>(row_of(c), row_of(n))
          .diagonal()
          .setConstant(carry[n][c] * part.mass[static_cast<Index>(c)]);
  return loads;
}

struct Mode {
  double rad_per_s, damping_ratio;
  VectorXd shape, turn;
  Eigen::RowVectorXd force;
};

// What a region gathers from the bodies it has a share of.
struct Gathered {
  std::vector<Mode> modes;
  MatrixXd compliance;  // (3 nodes, 3 nodes), s^2: the answer to a steady felt acceleration
};

// A region in the layout that is baked, and in the finest, whose nodes say how large a mode is.
struct Seen {
  const TissueLayout &layout, &finest;
  size_t index;
  const Region& region() const { return layout.regions[index]; }
};

VectorXd sizes_of(const MatrixXd& everywhere, const Seen& seen, const Cage& cage) {
  const Region& region = seen.finest.regions[seen.index];
  const MatrixXd shape = at_control_nodes(everywhere, seen.finest, region, cage);
  return shape.colwise().norm().transpose() / std::sqrt(static_cast<double>(region.node_count));
}

void append_modes(const Part& part, const MatrixXd& loads, const Seen& seen, const Cage& cage,
                  std::vector<Mode>* modes) {
  const TissueLayout& layout = seen.layout;
  const Region& region = seen.region();
  const MatrixXd everywhere = in_cage(part, part.modes.shape, cage);
  const MatrixXd shape = at_control_nodes(everywhere, layout, region, cage);
  const VectorXd sizes = sizes_of(everywhere, seen, cage);
  const Turning turning = turning_in_cage(everywhere, part, cage);
  const MatrixXd turn = at_control_nodes(warping_turn(turning), layout, region, cage);
  const MatrixXd force = part.modes.shape.transpose() * loads;
  for (Index k = 0; k < shape.cols(); ++k) {
    const double w = std::sqrt(part.modes.squared_rad_per_s[k]);
    const double size = sizes[k];
    if (!(w > 0) || !(size > 0)) continue;
    const double ratio = 0.5 * (part.rayleigh_mass_per_s / w + part.rayleigh_stiffness_s * w);
    modes->push_back(
        {w, std::min(ratio, kMostDamping), shape.col(k) / size, turn.col(k) / size, force.row(k) * size});
  }
}

void gather(const Part& part, const Seen& seen, const Cage& cage, Gathered* to) {
  const TissueLayout& layout = seen.layout;
  const Region& region = seen.region();
  const MatrixXd loads = loads_from_nodes(part, layout, region, cage);
  append_modes(part, loads, seen, cage, &to->modes);
  SparseCholesky cholesky;
  cholesky.analyze(part.stiffness);
  if (!cholesky.factor(part.stiffness))
    throw std::runtime_error("modal basis: no constrained node holds the flesh of region '" + region.name +
                             "' in place");
  to->compliance += at_control_nodes(in_cage(part, cholesky.solve(loads), cage), layout, region, cage);
}

size_t kept_modes(const std::vector<Mode>& ascending, int count) {
  const auto high = std::find_if(ascending.begin(), ascending.end(),
                                 [](const Mode& mode) { return mode.rad_per_s > kHighest_rad_per_s; });
  const auto below = static_cast<size_t>(high - ascending.begin());
  return std::min({ascending.size(), static_cast<size_t>(count), std::max(below, kFewest)});
}

// Of a shape's first columns: those of a beam, bent either way.
int stillest_node(const MatrixXd& shape) {
  const auto first = shape.leftCols(std::min<Index>(2, shape.cols()));
  Index least = 0;
  for (Index n = 0; n < first.rows() / 3; ++n)
    if (first.middleRows<3>(3 * n).norm() < first.middleRows<3>(3 * least).norm()) least = n;
  return static_cast<int>(least);
}

// intensity scales what is answered to a load, and so every displacement.
ModalBasis basis_of(Gathered gathered, int nodes, int count, double intensity) {
  std::vector<Mode>& modes = gathered.modes;
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
  basis.anchor_node = stillest_node(basis.shape);
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
  for (const FemLinear& body : bodies)
    for (const auto& [region, nodes] : split_by_region(body, of, cage, cage_node)) {
      const auto index = static_cast<size_t>(region);
      Part part = solve_part(body, nodes, cage_node, count + 1);
      if (layout.regions[index].frequency_hz > 0) damp_part(layout.regions[index].damping_ratio, &part);
      gather(part, {layout, of, index}, cage, &gathered[index]);
    }
  std::vector<ModalBasis> bases;
  for (size_t r = 0; r < layout.regions.size(); ++r)
    bases.push_back(
        basis_of(std::move(gathered[r]), layout.regions[r].node_count, count, layout.regions[r].intensity));
  return bases;
}

}  // namespace sinew::baker
