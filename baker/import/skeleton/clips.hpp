// clips.hpp  Animations of a file.
#pragma once
#include <tiny_gltf.h>

#include <vector>

#include "baker/import/gltf/accessor.hpp"
#include "baker/import/gltf/scene_graph.hpp"

namespace sinew::baker {

// One clip an animation. Channels that cannot be played (morph weights, matrix nodes, times that do not
// ascend) are left out and noted. Throws BadInput for indices and accessors out of range.
std::vector<Clip> read_clips(const tinygltf::Model& model, const SceneGraph& graph,
                             const AccessorReader& accessors, Source& source);

}  // namespace sinew::baker
