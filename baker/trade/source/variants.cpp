// variants.cpp  see variants.hpp.
#include "baker/trade/source/variants.hpp"

#include <filesystem>
#include <optional>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "baker/truth/tissue_truth.hpp"
#include "baker/truth/voxel_nodes.hpp"

namespace sinew::baker {
namespace {

constexpr int kLevels[] = {10, 20, 60};  // nodes a region

// Those of the truth: what clips allow is looked at at the nodes (mesh/regions/clip_frequency.hpp). Corners'
// stiffness goes with the square.
void take_frequencies(const BakedFrom& source, TissueLayout& layout) {
  const Recipe recipe = source.read();
  Character character = source.import(recipe);
  const TissueLayout own = layout_tissue(character, recipe);
  for (ControlNode& node : layout.nodes) {
    const auto r = static_cast<size_t>(node.region);
    const double ratio = own.regions[r].frequency_hz / layout.regions[r].frequency_hz;
    if (ratio > 0) node.corner.stiffness_per_s2 *= ratio * ratio;
  }
  for (size_t r = 0; r < layout.regions.size(); ++r)
    layout.regions[r].frequency_hz = own.regions[r].frequency_hz;
}

LoadedPack bake(const BakedFrom& source, int nodes_per_region, const std::string& weights_path) {
  Recipe recipe = source.read();
  if (nodes_per_region > 0) recipe.nodes_per_region = nodes_per_region;
  Character character = source.import(recipe);
  TissueLayout layout = layout_to_bake(character, recipe);
  if (nodes_per_region > 0) take_frequencies(source, layout);
  const std::vector<ModalBasis> modes =
      TissueTruth(character, layout, recipe).modal_bases(layout, kMostModes);
  const Safetensors weights = read_safetensors(weights_path);
  std::optional<Safetensors> rods, emulator;
  if (!source.rods.empty()) rods = read_safetensors(source.rods);
  if (!source.emulator.empty()) emulator = read_safetensors(source.emulator);
  return LoadedPack::from_bytes(pack_character(character, layout, modes, &weights, {},
                                               rods ? &*rods : nullptr, emulator ? &*emulator : nullptr),
                                source.glb);
}

}  // namespace

std::vector<Variant> variants_of(const BakedFrom& source) {
  std::vector<Variant> out;
  if (source.glb.empty() || source.weights.empty()) return out;
  const std::string own = source.weights.front();
  for (const int nodes : kLevels)
    out.push_back({std::to_string(nodes) + " nodes a region",
                   [&source, nodes, own] { return bake(source, nodes, own); }});
  for (size_t w = 1; w < source.weights.size(); ++w)
    out.push_back({std::filesystem::path(source.weights[w]).stem().string(),
                   [&source, w] { return bake(source, 0, source.weights[w]); }});
  return out;
}

}  // namespace sinew::baker
