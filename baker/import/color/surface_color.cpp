// surface_color.cpp  Colours of glTF are linear, pictures are sRGB.
#include "baker/import/color/surface_color.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

uint8_t byte(double value) { return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

double srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;  // IEC 61966-2-1
}

}  // namespace

std::vector<LinearColor> read_vertex_colors(const tinygltf::Primitive& primitive, size_t vertex_count,
                                            const AccessorReader& accessors, const std::string& where,
                                            const Source& source) {
  const auto found = primitive.attributes.find("COLOR_0");
  if (found == primitive.attributes.end()) return std::vector<LinearColor>(vertex_count, {1, 1, 1, 1});
  const std::string place = where + " COLOR_0";
  const int width = accessors.components(found->second, place);
  if (accessors.count(found->second, place) != vertex_count || (width != 3 && width != 4))
    source.refuse(
        place,
        "is not one colour of 3 or 4 numbers for each of " + std::to_string(vertex_count) + " vertices",
        "the file is damaged; export it again");
  const std::vector<double> values = accessors.numbers(found->second, width, place);
  std::vector<LinearColor> colors(vertex_count, {1, 1, 1, 1});
  for (size_t v = 0; v < vertex_count; ++v)
    for (size_t k = 0; k < static_cast<size_t>(width); ++k) {
      const double value = values[v * static_cast<size_t>(width) + k];
      colors[v][k] = std::isfinite(value) ? value : 1;
    }
  return colors;
}

LinearColor material_color(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                           const std::string& where, Source& source) {
  LinearColor color = {1, 1, 1, 1};
  if (primitive.material < 0) return color;
  if (static_cast<size_t>(primitive.material) >= model.materials.size()) {
    source.note(where, "names material " + std::to_string(primitive.material) + ", the file has " +
                           std::to_string(model.materials.size()) + ": drawn white");
    return color;
  }
  const auto& material = model.materials[static_cast<size_t>(primitive.material)].pbrMetallicRoughness;
  for (size_t k = 0; k < 4 && k < material.baseColorFactor.size(); ++k)
    if (std::isfinite(material.baseColorFactor[k])) color[k] = material.baseColorFactor[k];
  return color;
}

LinearColor product(const LinearColor& a, const LinearColor& b) {
  LinearColor color = a;
  for (size_t k = 0; k < 4; ++k) color[k] *= b[k];
  return color;
}

std::array<uint8_t, 4> surface_color(const LinearColor& material, const LinearColor& vertex) {
  const LinearColor color = product(material, vertex);
  return {byte(srgb(std::max(0.0, color[0]))), byte(srgb(std::max(0.0, color[1]))),
          byte(srgb(std::max(0.0, color[2]))), byte(color[3])};
}

}  // namespace sinew::baker
