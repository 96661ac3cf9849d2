// shown_meshes.hpp  Of meshes that stand in one place, such as levels of detail, those that a viewer shows.
#pragma once
#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "baker/import/skeleton/joints.hpp"

namespace sinew::baker {

// Drops what is not visible (KHR_node_visibility of its node or one above) and, of levels of detail, all but
// the finest: nodes or meshes whose names differ by a level alone (body_LOD0, LOD1/body), and what MSFT_lod
// lists. Notes name what is left out. kept: names or prefix* of what stays nevertheless (a recipe's
// "with_meshes"). Throws BadInput for a name that is no mesh's, and where nothing is left.
void keep_shown_meshes(const tinygltf::Model& model, const SceneGraph& graph,
                       const std::vector<std::string>& kept, Source& source,
                       std::vector<MeshInstance>& instances);

}  // namespace sinew::baker
