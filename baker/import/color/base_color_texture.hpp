// base_color_texture.hpp  Base colour textures of a file, looked up at vertices; for pictures only.
#pragma once
#include <tiny_gltf.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "baker/import/color/surface_color.hpp"
#include "baker/import/gltf/accessor.hpp"

namespace sinew::baker {

// PNG and JPEG of at most 8192 x 8192, as gltf_file.hpp leaves them: encoded. Decoded at first use.
class BaseColorTextures {
 public:
  explicit BaseColorTextures(const tinygltf::Model& model) : model_(model) {}

  // The texture of the primitive's material at each vertex, linear; empty where it has none, or where the
  // texture or its coordinates cannot be read, with a note. Repeats beyond 0..1, nearest pixel.
  std::vector<LinearColor> at_vertices(const tinygltf::Primitive& primitive, size_t vertex_count,
                                       const AccessorReader& accessors, const std::string& where,
                                       Source& source);

 private:
  struct Pixels {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  // empty: cannot be read
    LinearColor at(double u, double v) const;
  };
  const Pixels& pixels_of(size_t image);
  const tinygltf::Image* image_of(const tinygltf::TextureInfo& info) const;

  const tinygltf::Model& model_;
  std::map<size_t, Pixels> decoded_;
};

}  // namespace sinew::baker
