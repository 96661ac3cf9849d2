// body_parts.cpp  see body_parts.hpp.
#include "baker/truth/modes/body_parts.hpp"

#include <algorithm>
#include <cmath>

#include "baker/truth/numerics/modes.hpp"

namespace sinew::baker {
namespace {

using Eigen::Index;

// The control nodes whose flesh belongs to a body.
std::vector<int> control_nodes_of(const FemLinear& body, const TissueLayout& layout, const Cage& cage,
                                  const std::vector<int>& cage_node) {
  std::vector<bool> in_body(cage.nodes.size(), false);
  for (const int node : body.nodes) in_body[static_cast<size_t>(cage_node[static_cast<size_t>(node)])] = true;
  std::vector<int> found;
  const std::vector<ControlNode>& on_skin = nodes_on_skin(layout);
  for (size_t i = 0; i < on_skin.size(); ++i) {
    const Cage::Place& place = cage.surface[static_cast<size_t>(on_skin[i].vertex)];
    const auto& corners = cage.tetrahedra[static_cast<size_t>(place.tetrahedron)];
    if (std::any_of(corners.begin(), corners.end(), [&](int n) { return in_body[static_cast<size_t>(n)]; }))
      found.push_back(static_cast<int>(i));
  }
  return found;
}

}  // namespace

std::map<int, std::vector<size_t>> split_by_region(const FemLinear& body, const TissueLayout& layout,
                                                   const Cage& cage, const std::vector<int>& cage_node) {
  const std::vector<int> near = control_nodes_of(body, layout, cage, cage_node);
  const std::vector<ControlNode>& on_skin = nodes_on_skin(layout);
  std::map<int, std::vector<size_t>> parts;
  for (size_t i = 0; i < body.nodes.size() && !near.empty(); ++i) {
    const Vector3& place = cage.nodes[static_cast<size_t>(cage_node[static_cast<size_t>(body.nodes[i])])];
    const auto distance = [&](int n) {
      return (on_skin[static_cast<size_t>(n)].position - place).squaredNorm();
    };
    const int nearest =
        *std::min_element(near.begin(), near.end(), [&](int a, int b) { return distance(a) < distance(b); });
    parts[on_skin[static_cast<size_t>(nearest)].region].push_back(i);
  }
  return parts;
}

Eigen::SparseMatrix<double> block_of(const Eigen::SparseMatrix<double>& whole,
                                     const std::vector<size_t>& nodes) {
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

double first_rad_per_s(const FemLinear& body, const std::vector<size_t>& nodes) {
  Eigen::VectorXd mass(row_of(nodes.size()));
  for (size_t i = 0; i < nodes.size(); ++i)
    mass.segment<3>(row_of(i)) = body.mass.segment<3>(row_of(nodes[i]));
  return std::sqrt(lowest_modes(block_of(body.stiffness, nodes), mass, 1).squared_rad_per_s[0]);
}

}  // namespace sinew::baker
