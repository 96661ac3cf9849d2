// modal_basis.cpp  A region's lowest modes, from the cage's eigenproblem, as its control nodes see them.
#include "baker/truth/modal_basis.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "baker/mesh/carry.hpp"
#include "baker/truth/modes.hpp"

namespace sinew::baker {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A mode this high answers within a tick of 60 Hz and hardly at all; but a stiff region keeps its first few.
constexpr double kHighest_rad_per_s = 2 * M_PI * 30;
constexpr size_t kFewest = 6;

Index row_of(size_t node) { return 3 * static_cast<Index>(node); }

// The control nodes whose flesh belongs to a body.
std::vector<int> control_nodes_of(const FemLinear& body, const TissueLayout& layout, const Cage& cage,
                                  const std::vector<int>& cage_node) {
  std::vector<bool> in_body(cage.nodes.size(), false);
  for (const int node : body.nodes) in_body[static_cast<size_t>(cage_node[static_cast<size_t>(node)])] = true;
  std::vector<int> found;
  for (size_t i = 0; i < layout.nodes.size(); ++i) {
    const Cage::Place& place = cage.surface[static_cast<size_t>(layout.nodes[i].vertex)];
    const auto& corners = cage.tetrahedra[static_cast<size_t>(place.tetrahedron)];
    if (std::any_of(corners.begin(), corners.end(), [&](int n) { return in_body[static_cast<size_t>(n)]; }))
      found.push_back(static_cast<int>(i));
  }
  return found;
}

// A body's free nodes, each with the region of its nearest control node; empty where none touches the body.
std::map<int, std::vector<size_t>> split_by_region(const FemLinear& body, const TissueLayout& layout,
                                                   const Cage& cage, const std::vector<int>& cage_node) {
  const std::vector<int> near = control_nodes_of(body, layout, cage, cage_node);
  std::map<int, std::vector<size_t>> parts;
  for (size_t i = 0; i < body.nodes.size() && !near.empty(); ++i) {
    const Vector3& place =
        cage.nodes[static_cast<size_t>(cage_node[static_cast<size_t>(body.nodes[i])])];
    const auto distance = [&](int n) { return (layout.nodes[static_cast<size_t>(n)].position - place).squaredNorm(); };
    const int nearest = *std::min_element(near.begin(), near.end(),
                                          [&](int a, int b) { return distance(a) < distance(b); });
    parts[layout.nodes[static_cast<size_t>(nearest)].region].push_back(i);
  }
  return parts;
}

// Rows and columns of some nodes.
Eigen::SparseMatrix<double> block_of(const Eigen::SparseMatrix<double>& whole, const std::vector<size_t>& nodes) {
  std::vector<Index> to(static_cast<size_t>(whole.rows()), -1);
  for (size_t i = 0; i < nodes.size(); ++i)
    for (Index axis = 0; axis < 3; ++axis)
      to[static_cast<size_t>(row_of(nodes[i]) + axis)] = row_of(i) + axis;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index column = 0; column < whole.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(whole, column); it; ++it) {
      const Index row = to[static_cast<size_t>(it.row())], col = to[static_cast<size_t>(it.col())];
      if (row >= 0 && col >= 0) entries.emplace_back(row, col, it.value());
    }
  Eigen::SparseMatrix<double> block(row_of(nodes.size()), row_of(nodes.size()));
  block.setFromTriplets(entries.begin(), entries.end());
  return block;
}

// One body's share of a region.
struct Part {
  std::vector<int> cage_node;
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
  part.modes = lowest_modes(block_of(body.stiffness, nodes), mass, count);
  return part;
}

// Mode k of a part at the region's control nodes.
VectorXd shape_at_nodes(const Part& part, Index k, const TissueLayout& layout, const Region& region,
                        const Cage& cage) {
  std::map<int, Index> row;
  for (size_t i = 0; i < part.cage_node.size(); ++i) row[part.cage_node[i]] = row_of(i);
  VectorXd shape = VectorXd::Zero(3 * region.node_count);
  for (int n = 0; n < region.node_count; ++n) {
    const ControlNode& node = layout.nodes[static_cast<size_t>(region.first_node + n)];
    const Cage::Place& place = cage.surface[static_cast<size_t>(node.vertex)];
    for (size_t a = 0; a < 4; ++a) {
      const auto found = row.find(cage.tetrahedra[static_cast<size_t>(place.tetrahedron)][a]);
      if (found != row.end())
        shape.segment<3>(3 * n) += place.weight[a] * part.modes.shape.col(k).segment<3>(found->second);
    }
  }
  return shape;
}

// Half the curl of mode k at the region's control nodes: how flesh turns, for small q. Averaged over the
// tetrahedra around the cage's nodes, by volume, and read off at the node's place.
struct Curl {
  std::vector<Vector3> sum;
  std::vector<double> volume;
};

VectorXd turn_at_nodes(const Part& part, Index k, const TissueLayout& layout, const Region& region,
                       const Cage& cage) {
  std::map<int, Index> row;
  for (size_t i = 0; i < part.cage_node.size(); ++i) row[part.cage_node[i]] = row_of(i);
  Curl curl{std::vector<Vector3>(cage.nodes.size(), Vector3::Zero()), std::vector<double>(cage.nodes.size())};
  for (const auto& t : cage.tetrahedra) {
    if (std::none_of(t.begin(), t.end(), [&](int n) { return row.count(n) > 0; })) continue;
    Eigen::Matrix3d edges, moved;
    const auto shape = [&](int n) -> Vector3 {
      const auto found = row.find(n);
      return found == row.end() ? Vector3(Vector3::Zero()) : Vector3(part.modes.shape.col(k).segment<3>(found->second));
    };
    for (int a = 0; a < 3; ++a) {
      edges.col(a) = cage.nodes[static_cast<size_t>(t[static_cast<size_t>(a) + 1])] - cage.nodes[static_cast<size_t>(t[0])];
      moved.col(a) = shape(t[static_cast<size_t>(a) + 1]) - shape(t[0]);
    }
    const Eigen::Matrix3d gradient = moved * edges.inverse();
    const double volume = edges.determinant();
    const Vector3 turn = 0.5 * Vector3(gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0),
                                       gradient(1, 0) - gradient(0, 1));
    for (const int n : t) {
      curl.sum[static_cast<size_t>(n)] += volume * turn;
      curl.volume[static_cast<size_t>(n)] += volume;
    }
  }
  VectorXd turn = VectorXd::Zero(3 * region.node_count);
  for (int n = 0; n < region.node_count; ++n) {
    const ControlNode& node = layout.nodes[static_cast<size_t>(region.first_node + n)];
    const Cage::Place& place = cage.surface[static_cast<size_t>(node.vertex)];
    for (size_t a = 0; a < 4; ++a) {
      const auto corner = static_cast<size_t>(cage.tetrahedra[static_cast<size_t>(place.tetrahedron)][a]);
      if (curl.volume[corner] > 0)
        turn.segment<3>(3 * n) += place.weight[a] * curl.sum[corner] / curl.volume[corner];
    }
  }
  return turn;
}

// Generalised forces of mode k: felt accelerations at the control nodes, carried through the flesh.
VectorXd force_from_nodes(const Part& part, Index k, const std::vector<std::vector<double>>& carry) {
  VectorXd force = VectorXd::Zero(3 * static_cast<Index>(carry.size()));
  for (size_t n = 0; n < carry.size(); ++n)
    for (size_t c = 0; c < part.cage_node.size(); ++c)
      force.segment<3>(row_of(n)) += carry[n][c] * part.mass[static_cast<Index>(c)] *
                                     part.modes.shape.col(k).segment<3>(row_of(c));
  return force;
}

struct Mode {
  double rad_per_s, damping_ratio;
  VectorXd shape, turn, force;
};

void append_modes(const Part& part, const TissueLayout& layout, const Region& region, const Cage& cage,
                  std::vector<Mode>* modes) {
  std::vector<Vector3> nodes, flesh;
  for (int n = 0; n < region.node_count; ++n)
    nodes.push_back(layout.nodes[static_cast<size_t>(region.first_node + n)].position);
  for (const int node : part.cage_node) flesh.push_back(cage.nodes[static_cast<size_t>(node)]);
  const std::vector<std::vector<double>> carry = carry_weights(nodes, {}, flesh);
  for (Index k = 0; k < part.modes.squared_rad_per_s.size(); ++k) {
    const double w = std::sqrt(part.modes.squared_rad_per_s[k]);
    const VectorXd shape = shape_at_nodes(part, k, layout, region, cage);
    const double size = shape.norm() / std::sqrt(static_cast<double>(region.node_count));
    if (!(w > 0) || !(size > 0)) continue;
    if (w > kHighest_rad_per_s && modes->size() >= kFewest) break;
    modes->push_back({w, 0.5 * (part.rayleigh_mass_per_s / w + part.rayleigh_stiffness_s * w), shape / size,
                      turn_at_nodes(part, k, layout, region, cage) / size, force_from_nodes(part, k, carry) * size});
  }
}

ModalBasis basis_of(std::vector<Mode> modes, int nodes, int count) {
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return a.rad_per_s < b.rad_per_s; });
  modes.resize(std::min(modes.size(), static_cast<size_t>(count)));
  const auto kept = static_cast<Index>(modes.size());
  ModalBasis basis{VectorXd(kept), VectorXd(kept), MatrixXd(3 * nodes, kept), MatrixXd(3 * nodes, kept), MatrixXd(kept, 3 * nodes)};
  for (Index k = 0; k < kept; ++k) {
    const Mode& mode = modes[static_cast<size_t>(k)];
    basis.rad_per_s[k] = mode.rad_per_s;
    basis.damping_ratio[k] = mode.damping_ratio;
    basis.shape.col(k) = mode.shape;
    basis.turn.col(k) = mode.turn;
    basis.force.row(k) = mode.force;
  }
  return basis;
}

}  // namespace

std::vector<ModalBasis> modal_bases(const TissueLayout& layout, const Cage& cage,
                                    const std::vector<FemLinear>& bodies, const std::vector<int>& cage_node,
                                    int count) {
  std::vector<std::vector<Mode>> modes(layout.regions.size());
  for (const FemLinear& body : bodies)
    for (const auto& [region, nodes] : split_by_region(body, layout, cage, cage_node))
      append_modes(solve_part(body, nodes, cage_node, count), layout,
                   layout.regions[static_cast<size_t>(region)], cage, &modes[static_cast<size_t>(region)]);
  std::vector<ModalBasis> bases;
  for (size_t r = 0; r < layout.regions.size(); ++r)
    bases.push_back(basis_of(std::move(modes[r]), layout.regions[r].node_count, count));
  return bases;
}

}  // namespace sinew::baker
