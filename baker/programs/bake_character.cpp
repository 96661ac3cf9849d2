// bake_character.cpp  sinew-bake character: a skinned character, its modes and trained weights to one .sinew
// file.
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "baker/audit/limit_factor.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/common/progress.hpp"
#include "baker/common/write_file.hpp"
#include "baker/mesh/import_character.hpp"
#include "baker/mesh/tissue_layout.hpp"
#include "baker/pack/character_pack.hpp"
#include "baker/pack/network_pack.hpp"
#include "baker/pack/pack_writer.hpp"
#include "baker/preview/write_preview.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/describe.hpp"
#include "baker/programs/measure_tiers.hpp"
#include "baker/programs/part_table.hpp"
#include "baker/truth/tissue_truth.hpp"

namespace sinew::baker {
namespace {

struct CharacterOptions {
  std::string character, recipe, tissue, output, preview;
  bool quick = false, keep_network = false;
};

void print_summary(const CharacterOptions& options, const Character& character, const TissueLayout& layout,
                   const LoadedPack& pack) {
  for (const std::string& note : character.notes) std::printf("note: %s\n", note.c_str());
  for (const std::string& note : notes_on(pack.view())) std::printf("note: %s\n", note.c_str());
  std::printf("%s", part_table(layout, pack.view()).c_str());
  nlohmann::ordered_json description = describe_pack(pack);
  for (const char* detail : {"network", "metadata"}) description.erase(detail);  // `info` shows them
  std::printf("%s: %s", options.output.c_str(), format_description(description).c_str());
}

// A character's tissue before it is packed; of rods alone it has neither truth nor bases.
struct Tissue {
  TissueLayout layout;
  std::unique_ptr<TissueTruth> truth;
  std::vector<ModalBasis> finest;
  std::vector<GraphLevel> coarser;

  // Of a part that moves by this share of its size, regions before rods; true where it is one that may be
  // scaled, and was.
  bool scale_limit(size_t part, double factor, double moved_share) {
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
    for (GraphLevel& level : coarser) level.layout.regions[part].max_displacement *= factor;
    return true;
  }
};

Tissue make_tissue(Character& character, const Recipe& recipe) {
  Tissue tissue{.layout = layout_tissue(character, recipe), .truth = {}, .finest = {}, .coarser = {}};
  if (tissue.layout.regions.empty()) return tissue;
  tissue.truth = std::make_unique<TissueTruth>(character, tissue.layout, recipe);
  const std::vector<std::string>& notes = tissue.truth->cage().notes;
  character.notes.insert(character.notes.end(), notes.begin(), notes.end());
  tissue.finest = tissue.truth->modal_bases(tissue.layout, kMostModes);
  tissue.coarser = coarser_levels(character, recipe, *tissue.truth, tissue.layout, tissue.finest);
  return tissue;
}

// Packs it with these weights, or without.
class Packer {
 public:
  Packer(const Character& character, const Tissue& tissue) : character_(character), tissue_(tissue) {}

  std::vector<std::byte> pack(const Safetensors* weights) const {
    return pack_character(character_, tissue_.layout, tissue_.finest, weights, tissue_.coarser);
  }

 private:
  const Character& character_;
  const Tissue& tissue_;
};

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

// Flesh with a narrow rim tears where other flesh only swings, and so does skin of which a lock has a part:
// limits that no recipe states are lowered until a quick audit of the modal base is within its bounds.
void lower_limits(const Packer& packer, Character& character, Tissue& tissue) {
  constexpr int kMostRounds = 6;
  const std::vector<Region> before = tissue.layout.regions;
  const std::vector<Rod> rods_before = tissue.layout.rods;
  bool lowered = !tissue.layout.regions.empty() || !tissue.layout.rods.empty();
  for (int round = 0; lowered && round < kMostRounds; ++round) {
    const LoadedPack pack = LoadedPack::from_bytes(packer.pack(nullptr), character.name);
    const Audit audit = quick_audit({pack.view(), pack.bytes()});
    lowered = false;
    for (size_t p = 0; p < audit.parts.size(); ++p) {
      const PartAudit& part = audit.parts[p];
      lowered |= tissue.scale_limit(p, limit_factor(part, audit.height_m),
                                    part.displacement_m.value / part.part.size_m);
    }
  }
  for (size_t r = 0; r < before.size(); ++r)
    if (tissue.layout.regions[r].max_displacement < before[r].max_displacement)
      character.notes.push_back(limit_note(before[r], tissue.layout.regions[r]));
  for (size_t r = 0; r < rods_before.size(); ++r)
    if (tissue.layout.rods[r].max_displacement != rods_before[r].max_displacement)
      character.notes.push_back(limit_note(tissue.layout.rods[r]));
}

std::vector<std::byte> with_tiers(const std::vector<std::byte>& bytes,
                                  const std::vector<pack::TierRecord>& tiers) {
  PackWriter writer = PackWriter::from_pack(bytes);
  writer.section(pack::SectionKind::kTiers, tiers);
  return writer.finish();
}

std::string network_note(const std::vector<pack::TierRecord>& tiers) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the network is left out: on this character its error is %.3f of skinning's, its modal base's "
      "%.3f; sinew-train fine-tunes it",
      error_ratio_of(tiers, Tier::kNetwork), error_ratio_of(tiers, Tier::kModal));
  return text;
}

std::string no_gain_note(double ratio) {
  char text[200];
  std::snprintf(text, sizeof text,
                "its flesh is %.2f of skinning's error off the truth: a world leaves it to skinning; state a "
                "higher frequency_hz or max_displacement",
                ratio);
  return text;
}

// A likely cause of a large error: what a limit has to hold back by so much is too soft for its size.
void note_too_soft(const TissueLayout& layout, const ShortTruths& truths, std::vector<std::string>& notes) {
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    const Region& region = layout.regions[r];
    if (truths.moved_radii[r] <= std::max(1.0, region.max_displacement)) continue;
    char text[200];
    std::snprintf(text, sizeof text,
                  "'%s' would move by %.1f times its radius but for its limit: it is too soft for its size; "
                  "state a higher frequency_hz",
                  region.name.c_str(), truths.moved_radii[r]);
    notes.push_back(text);
  }
}

// The pack with the errors of this character, and without a network that does not pay on it.
std::vector<std::byte> measured(const Packer& packer, const Recipe& recipe, const Safetensors* weights,
                                bool keep_network, Character& character, const Tissue& tissue) {
  std::vector<std::byte> bytes = packer.pack(weights);
  try {
    LoadedPack pack = LoadedPack::from_bytes(bytes, character.name);
    const ShortTruths truths = short_truths(character, tissue.layout, recipe, tissue.finest, pack.view());
    note_too_soft(tissue.layout, truths, character.notes);
    std::vector<pack::TierRecord> tiers = measured_tiers(pack, truths);
    if (weights && !keep_network && !network_pays(tiers)) {
      character.notes.push_back(network_note(tiers));
      bytes = packer.pack(nullptr);
      tiers = measured_tiers(LoadedPack::from_bytes(bytes, character.name), truths);
    }
    double least = std::numeric_limits<double>::infinity();
    for (const Tier tier : {Tier::kModal, Tier::kNetwork})
      least = std::fmin(least, error_ratio_of(tiers, tier));
    if (least >= 1 && std::isfinite(least)) character.notes.push_back(no_gain_note(least));
    return with_tiers(bytes, tiers);
  } catch (const std::runtime_error& problem) {
    const char* what = keep_network || !weights ? "errors are not measured: "
                                                : "errors are not measured, and a network is left out: ";
    character.notes.push_back(what + std::string(problem.what()));
    return packer.pack(keep_network ? weights : nullptr);
  }
}

void run_character(const CharacterOptions& options) {
  refuse_directory(options.output);
  const Recipe recipe = options.recipe.empty() ? Recipe{} : read_recipe(options.recipe);
  std::optional<Safetensors> weights;
  if (!options.tissue.empty()) weights = read_safetensors(options.tissue);
  std::optional<Progress> progress(std::in_place, "baking " + options.output, 10);
  Character character = import_character(options.character, recipe);
  progress->update(1);
  Tissue tissue = make_tissue(character, recipe);
  progress->update(6);
  if (tissue.layout.regions.empty() && weights) {
    check_model(*weights);
    character.notes.push_back("nothing is soft tissue: " + options.tissue + " is not used");
    weights.reset();
  }
  const Packer packer(character, tissue);
  lower_limits(packer, character, tissue);
  const Safetensors* network = weights ? &*weights : nullptr;
  const std::vector<std::byte> bytes =
      options.quick || !tissue.truth
          ? packer.pack(network)
          : measured(packer, recipe, network, options.keep_network, character, tissue);
  const LoadedPack pack =
      LoadedPack::from_bytes(bytes, options.character);  // what the runtime would refuse is not written
  if (!options.quick)
    for (std::string& warning : quick_audit({pack.view(), pack.bytes()}).failures)
      character.notes.push_back("audit: " + std::move(warning));
  if (!options.preview.empty()) write_preview(options.preview, pack.view());
  write_file(options.output, bytes);
  progress.reset();
  print_summary(options, character, tissue.layout, pack);
}

}  // namespace

void add_character_command(CLI::App& app, int*) {
  auto options = std::make_shared<CharacterOptions>();
  CLI::App* command =
      app.add_subcommand("character", "Packs a skinned character with its tissue's modes and network");
  command->add_option("character", options->character, "skinned glTF or VRM")->required();
  command->add_option("--recipe", options->recipe, "JSON; see baker/mesh/recipe.hpp");
  command->add_option("--tissue", options->tissue, "trained weights, safetensors; without: modes only");
  command->add_flag("--quick", options->quick,
                    "does not measure errors against ground truth, nor whether the network pays: for trying");
  command->add_flag("--keep-network", options->keep_network,
                    "packs the network whatever its error is; sinew-train has judged it on more motions");
  add_output(*command, "-o,--output", options->output, "C.sinew")->required();
  add_output(*command, "--preview", options->preview, "picture of what moves by itself, .png");
  command->callback([options] { run_character(*options); });
}

}  // namespace sinew::baker
