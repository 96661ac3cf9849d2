// pose.hpp  Node transforms to global matrices.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

Matrix4 local_matrix(const Node& node);
// root x the product down from the root, of every node; parents must come first.
std::vector<Matrix4> global_matrices(const std::vector<Node>& nodes, const Matrix4& root);

}  // namespace sinew::baker
