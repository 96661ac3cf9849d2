// character_tissue.cpp  Layout, truth, modes, and limits by audit.
#include "baker/programs/character_tissue.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "baker/audit/audit.hpp"
#include "baker/audit/limit_factor.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "baker/truth/voxel_nodes.hpp"

namespace sinew::baker {
namespace {

// Of a part that moves by this share of its size, regions before rods; true where it is one that may be
// scaled, and was.
bool scale_limit(CharacterTissue& tissue, size_t part, double factor, double moved_share) {
  TissueLayout& layout = tissue.layout;
  const size_t regions = layout.regions.size();
  if (factor >= 1) return false;
  if (part >= regions) {
    Rod& rod = layout.rods[part - regions];
    if (rod.states_limit) return false;
    rod.max_displacement = factor * (rod.max_displacement > 0 ? rod.max_displacement : moved_share);
    return true;
  }
  if (layout.regions[part].states_limit) return false;
  layout.regions[part].max_displacement *= factor;
  for (GraphLevel& level : tissue.coarser) level.layout.regions[part].max_displacement *= factor;
  return true;
}

std::string limit_note(const Region& before, const Region& after) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "'%s' may move by %.2f of its radius, not %.2f: further its skin would tear; add bones around it, "
      "or state max_displacement",
      after.name.c_str(), after.max_displacement, before.max_displacement);
  return text;
}

std::string limit_note(const Rod& rod) {
  char text[200];
  std::snprintf(text, sizeof text,
                "'%s' may swing by %.2f of its length: further its skin would tear; mend its weights, or "
                "state max_displacement in a recipe's \"rods\"",
                rod.name.c_str(), rod.max_displacement);
  return text;
}

}  // namespace

CharacterTissue make_tissue(Character& character, const Recipe& recipe) {
  CharacterTissue tissue{
      .layout = layout_to_bake(character, recipe), .truth = {}, .finest = {}, .coarser = {}};
  if (tissue.layout.regions.empty()) return tissue;
  tissue.truth = std::make_unique<TissueTruth>(character, tissue.layout, recipe);
  const std::vector<std::string>& notes = tissue.truth->cage().notes;
  character.notes.insert(character.notes.end(), notes.begin(), notes.end());
  tissue.finest = tissue.truth->modal_bases(tissue.layout, kMostModes);
  const bool on_voxels = !tissue.layout.skin_nodes.empty();
  if (on_voxels && !recipe.coarser_nodes.empty() &&
      (!recipe.left_out.empty() || recipe.coarser_nodes != Recipe{}.coarser_nodes))
    character.notes.push_back(
        "\"levels\" and \"left_out\" are not used: with emulated regions there is one control graph");
  if (!on_voxels)
    tissue.coarser = coarser_levels(character, recipe, *tissue.truth, tissue.layout, tissue.finest);
  return tissue;
}

std::vector<std::byte> pack_tissue(const Character& character, const CharacterTissue& tissue,
                                   const Safetensors* weights) {
  return pack_character(character, tissue.layout, tissue.finest, weights, tissue.coarser, tissue.rod_weights,
                        tissue.emulator);
}

void lower_limits(Character& character, CharacterTissue& tissue) {
  constexpr int kMostRounds = 6;
  const Safetensors* const emulator = std::exchange(tissue.emulator, nullptr);
  const std::vector<Region> before = tissue.layout.regions;
  const std::vector<Rod> rods_before = tissue.layout.rods;
  std::optional<AuditedParts> parts;  // the same in every round
  std::optional<LayerGaps> gaps;
  bool lowered = !tissue.layout.regions.empty() || !tissue.layout.rods.empty();
  for (int round = 0; lowered && round < kMostRounds; ++round) {
    const LoadedPack pack = LoadedPack::from_bytes(pack_tissue(character, tissue, nullptr), character.name);
    if (!gaps) gaps.emplace(pack.view(), parts.emplace(find_parts(pack.view())));
    const Audit audit = quick_audit({pack.view(), pack.bytes()}, *parts, *gaps);
    lowered = false;
    for (size_t p = 0; p < audit.parts.size(); ++p) {
      const PartAudit& part = audit.parts[p];
      lowered |= scale_limit(tissue, p, limit_factor(part, audit.height_m),
                             part.displacement_m.value / part.part.size_m);
    }
  }
  tissue.emulator = emulator;
  for (size_t r = 0; r < before.size(); ++r)
    if (tissue.layout.regions[r].max_displacement < before[r].max_displacement)
      character.notes.push_back(limit_note(before[r], tissue.layout.regions[r]));
  for (size_t r = 0; r < rods_before.size(); ++r)
    if (tissue.layout.rods[r].max_displacement != rods_before[r].max_displacement)
      character.notes.push_back(limit_note(tissue.layout.rods[r]));
}

}  // namespace sinew::baker
