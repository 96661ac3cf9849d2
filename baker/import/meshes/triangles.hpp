// triangles.hpp  Triangles of a primitive: lists, strips and fans, indexed or not.
#pragma once
#include <array>
#include <vector>

#include "baker/import/gltf/accessor.hpp"

namespace sinew::baker {

bool is_triangle_mode(int mode);

// Corners name vertices of the primitive. Throws BadInput: an index past the vertices, or the restart value,
// which glTF forbids.
std::vector<std::array<int, 3>> read_triangles(const tinygltf::Primitive& primitive, size_t vertex_count,
                                               const AccessorReader& accessors, const std::string& where,
                                               Source& source);

}  // namespace sinew::baker
