// mesh_names.hpp  Meshes left out by the names that artists gave them.
#pragma once
#include <string>
#include <vector>

#include "baker/import/skeleton/joints.hpp"

namespace sinew::baker {

// For each instance, whether a name, or prefix*, is the mesh's or the showing node's. Throws BadInput for a
// name that is no mesh's, with the nearest one; `key`: the recipe's.
std::vector<bool> match_meshes(const tinygltf::Model& model, const SceneGraph& graph,
                               const std::vector<std::string>& names, const std::string& key,
                               const Source& source, const std::vector<MeshInstance>& instances);

// Drops the instances of which a name, or prefix*, is the mesh's or the showing node's. Throws BadInput for a
// name that is no mesh's, with the nearest one, and where nothing is left.
void leave_out_meshes(const tinygltf::Model& model, const SceneGraph& graph,
                      const std::vector<std::string>& names, Source& source,
                      std::vector<MeshInstance>& instances);

}  // namespace sinew::baker
