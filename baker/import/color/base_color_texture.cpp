// base_color_texture.cpp  see base_color_texture.hpp.
#include "baker/import/color/base_color_texture.hpp"

#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

constexpr int kMostPixels = 8192;  // a side

double linear(uint8_t byte) {  // IEC 61966-2-1
  const double srgb = byte / 255.0;
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

int wrapped(double coordinate, int size) {
  const double share = coordinate - std::floor(coordinate);
  return std::clamp(static_cast<int>(share * size), 0, size - 1);
}

}  // namespace

LinearColor BaseColorTextures::Pixels::at(double u, double v) const {
  if (!std::isfinite(u) || !std::isfinite(v)) return {1, 1, 1, 1};
  const auto pixel = static_cast<size_t>(wrapped(v, height)) * static_cast<size_t>(width) +
                     static_cast<size_t>(wrapped(u, width));
  const uint8_t* rgba_here = &rgba[4 * pixel];
  return {linear(rgba_here[0]), linear(rgba_here[1]), linear(rgba_here[2]), rgba_here[3] / 255.0};
}

const tinygltf::Image* BaseColorTextures::image_of(const tinygltf::TextureInfo& info) const {
  const auto texture = static_cast<size_t>(info.index);
  if (texture >= model_.textures.size()) return nullptr;
  const int image = model_.textures[texture].source;
  if (image < 0 || static_cast<size_t>(image) >= model_.images.size()) return nullptr;
  return &model_.images[static_cast<size_t>(image)];
}

const BaseColorTextures::Pixels& BaseColorTextures::pixels_of(size_t image) {
  const auto [found, fresh] = decoded_.try_emplace(image);
  if (!fresh) return found->second;
  const std::vector<unsigned char>& bytes = model_.images[image].image;
  Pixels& pixels = found->second;
  const auto size = static_cast<int>(bytes.size());
  int channels = 0;
  if (!stbi_info_from_memory(bytes.data(), size, &pixels.width, &pixels.height, &channels)) return pixels;
  if (pixels.width > kMostPixels || pixels.height > kMostPixels) return pixels;
  uint8_t* rgba = stbi_load_from_memory(bytes.data(), size, &pixels.width, &pixels.height, &channels, 4);
  if (rgba == nullptr) return pixels;
  pixels.rgba.assign(
      rgba, rgba + size_t{4} * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
  stbi_image_free(rgba);
  return pixels;
}

std::vector<LinearColor> BaseColorTextures::at_vertices(const tinygltf::Primitive& primitive,
                                                        size_t vertex_count, const AccessorReader& accessors,
                                                        const std::string& where, Source& source) {
  if (primitive.material < 0 || static_cast<size_t>(primitive.material) >= model_.materials.size()) return {};
  const tinygltf::TextureInfo& info =
      model_.materials[static_cast<size_t>(primitive.material)].pbrMetallicRoughness.baseColorTexture;
  if (info.index < 0) return {};
  const tinygltf::Image* image = image_of(info);
  const auto coordinates = primitive.attributes.find("TEXCOORD_" + std::to_string(info.texCoord));
  const auto flat = [&] {
    source.note(where, "its base colour texture cannot be read: flat material colour");
    return std::vector<LinearColor>{};
  };
  if (image == nullptr || coordinates == primitive.attributes.end()) return flat();
  const Pixels& pixels = pixels_of(static_cast<size_t>(image - model_.images.data()));
  if (pixels.rgba.empty()) return flat();
  try {
    const std::string place = where + " " + coordinates->first;
    if (accessors.count(coordinates->second, place) != vertex_count) return flat();
    const std::vector<double> uv = accessors.numbers(coordinates->second, 2, place);
    std::vector<LinearColor> colors;
    for (size_t v = 0; v < vertex_count; ++v) colors.push_back(pixels.at(uv[2 * v], uv[2 * v + 1]));
    return colors;
  } catch (const BadInput&) {  // colours are ornament: what is damaged there refuses no character
    return flat();
  }
}

}  // namespace sinew::baker
