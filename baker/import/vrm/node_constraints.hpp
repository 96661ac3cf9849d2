// node_constraints.hpp  VRMC_node_constraint of a file's nodes.
#pragma once
#include <tiny_gltf.h>

#include "baker/import/gltf/scene_graph.hpp"
#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

// Sets Node::constraint. One that is damaged, or whose node is a matrix, is noted with the node's name and
// left out.
void read_node_constraints(const tinygltf::Model& model, SceneGraph& graph, Source& source);

}  // namespace sinew::baker
