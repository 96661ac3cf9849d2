// paint.hpp  Painted stiffness of a primitive.
#pragma once
#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "baker/import/gltf/accessor.hpp"
#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

// _STIFFNESS of each vertex, 0 soft .. 1 rigid, whatever the case of its letters; of a vector or colour its
// first number. Integers that are not marked as normalised and exceed 1 are shares of their type's largest.
// What lies outside of 0..1 is clamped and noted. Empty: not painted.
std::vector<double> read_paint(const tinygltf::Primitive& primitive, size_t vertex_count,
                               const AccessorReader& accessors, const std::string& where, Source& source);

}  // namespace sinew::baker
