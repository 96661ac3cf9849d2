// primitives.hpp  Meshes of a file appended to a character: vertices, influences, colours, triangles.
#pragma once
#include <vector>

#include "baker/import/meshes/tangents.hpp"
#include "baker/import/skeleton/joints.hpp"

namespace sinew::baker {

// Appends the vertices of all instances in bind space, scene units. Primitives of one mesh that share their
// vertices are stored once. Normals and tangents that the file lacks are zero. Returns TEXCOORD_0 of each
// vertex, NaN where there is none. Throws BadInput, among others for more than max_vertices, before anything
// is copied.
std::vector<Vector2> append_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                                   const Joints& joints, const std::vector<MeshInstance>& instances,
                                   size_t max_vertices, Source& source, Character& character);

}  // namespace sinew::baker
