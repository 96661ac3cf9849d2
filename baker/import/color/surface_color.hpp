// surface_color.hpp  Material x texture x vertex colour as sRGB bytes; for pictures only.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "baker/import/gltf/accessor.hpp"

namespace sinew::baker {

using LinearColor = std::array<double, 4>;

// COLOR_0, linear; white where the primitive has none.
std::vector<LinearColor> read_vertex_colors(const tinygltf::Primitive& primitive, size_t vertex_count,
                                            const AccessorReader& accessors, const std::string& where,
                                            const Source& source);
// The base colour factor.
LinearColor material_color(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                           const std::string& where, Source& source);
LinearColor product(const LinearColor& a, const LinearColor& b);
std::array<uint8_t, 4> surface_color(const LinearColor& material, const LinearColor& vertex);

}  // namespace sinew::baker
