// scene_graph.hpp  The file's nodes in an order in which parents come first.
#pragma once
#include <tiny_gltf.h>

#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

struct SceneGraph {
  std::vector<Node> nodes;
  std::vector<int> node_of_file;  // the file's node index -> index in nodes
  std::vector<bool> in_scene;     // of nodes; all, where the file has no scene
  std::vector<Matrix4> rest;      // scene-from-node of the file's rest pose
};

// An order in which parents come before children and which otherwise keeps the given one; shorter than parent
// when there is a cycle.
std::vector<int> parents_first(const std::vector<int>& parent);

// Throws BadInput: children out of range, two parents, a cycle, transforms that are not numbers.
SceneGraph read_scene_graph(const tinygltf::Model& model, Source& source);

}  // namespace sinew::baker
