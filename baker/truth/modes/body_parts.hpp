// body_parts.hpp  Which of a body's free nodes belong to which region, and their share of its matrices.
#pragma once
#include <map>
#include <vector>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/truth/cage/cage.hpp"
#include "baker/truth/fem/fem.hpp"

namespace sinew::baker {

inline Eigen::Index row_of(size_t node) { return 3 * static_cast<Eigen::Index>(node); }

// A body's free nodes (indices into body.nodes), each with the region of its nearest node on the skin; empty
// where none touches the body. cage_node: a node of the body -> of the cage.
std::map<int, std::vector<size_t>> split_by_region(const FemLinear& body, const TissueLayout& layout,
                                                   const Cage& cage, const std::vector<int>& cage_node);

// Rows and columns of some nodes.
Eigen::SparseMatrix<double> block_of(const Eigen::SparseMatrix<double>& whole,
                                     const std::vector<size_t>& nodes);

// The lowest mode of some nodes, all others held still.
double first_rad_per_s(const FemLinear& body, const std::vector<size_t>& nodes);

}  // namespace sinew::baker
