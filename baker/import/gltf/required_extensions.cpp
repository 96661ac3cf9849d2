// required_extensions.cpp  Those that are followed, or that only say how a surface looks.
#include "baker/import/gltf/required_extensions.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace sinew::baker {
namespace {

// A name that ends in _ stands for all that begin so.
constexpr std::string_view kFine[] = {
    "KHR_mesh_quantization", "EXT_meshopt_compression", "KHR_node_visibility", "MSFT_lod", "VRM", "VRMC_vrm",
    "VRMC_springBone", "VRMC_node_constraint",
    // Surfaces, pictures, lights and what is told of a file.
    "KHR_materials_", "VRMC_materials_", "EXT_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
    "MSFT_packing_", "KHR_techniques_", "KHR_lights_", "EXT_lights_", "KHR_xmp", "KHR_xmp_"};

constexpr std::string_view kCompressed[] = {"KHR_draco_mesh_compression", "KHR_meshopt_compression"};

bool is_fine(std::string_view name) {
  return std::ranges::any_of(kFine, [&](std::string_view fine) {
    return fine.ends_with('_') ? name.starts_with(fine) : name == fine;
  });
}

}  // namespace

void check_required_extensions(const tinygltf::Model& model, const Source& source) {
  for (const std::string& name : model.extensionsRequired) {
    if (std::ranges::find(kCompressed, name) != std::end(kCompressed))
      source.refuse("extensionsRequired", "the geometry is compressed by " + name,
                    "export without mesh compression (gltf-transform copy IN OUT unpacks it)");
    if (!is_fine(name))
      source.refuse("extensionsRequired", "the file needs " + name + ", which is not followed here",
                    "export without that extension");
  }
}

}  // namespace sinew::baker
