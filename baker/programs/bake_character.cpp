// bake_character.cpp  sinew-bake character: a skinned character, its modes and trained weights to one .sinew
// file.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "baker/audit/audit.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/common/progress.hpp"
#include "baker/measure/measure_tiers.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/recipe/import_character.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "baker/pack/character/patches_pack.hpp"
#include "baker/pack/network/dense_pack.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "baker/pack/network/trained_rods.hpp"
#include "baker/pack/pack_writer.hpp"
#include "baker/preview/write_preview.hpp"
#include "baker/programs/character_tissue.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/describe/describe.hpp"
#include "baker/programs/describe/part_table.hpp"
#include "baker/truth/tissue_truth.hpp"

namespace sinew::baker {
namespace {

struct CharacterOptions {
  std::string character, recipe, tissue, emulator, rods, output, preview;
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

std::vector<std::byte> with_tiers(const std::vector<std::byte>& bytes,
                                  const std::vector<pack::TierRecord>& tiers) {
  PackWriter writer = PackWriter::from_pack(bytes);
  writer.section(pack::SectionKind::kTiers, tiers);
  return writer.finish();
}

std::string network_note(double error, double without, const char* of) {
  char text[200];
  std::snprintf(text, sizeof text,
                "the network is left out: on this character its error is %.3f of skinning's, %s "
                "%.3f; sinew-train fine-tunes it",
                error, of, without);
  return text;
}

// What the recipe chose a world moves it by, nearer or not.
std::string far_emulator_note(const std::vector<pack::TierRecord>& tiers) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "emulated patches leave %.3f of skinning's error on this character, its modes alone %.3f: leave "
      "\"model\" out of the recipe for the nearer",
      error_ratio_of(tiers, Tier::kNetwork), error_ratio_of(tiers, Tier::kModal));
  return text;
}

std::string no_gain_note(double ratio) {
  char text[200];
  std::snprintf(text, sizeof text,
                "its soft tissue leaves %.2f of skinning's error: a world skins it instead; state a "
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

struct Measured {
  std::vector<std::byte> bytes;
  std::vector<pack::TierRecord> tiers;
};

// A character's bake against its truth.
struct Judge {
  const Character& character;
  const CharacterTissue& tissue;
  const ShortTruths& truths;

  Measured measure(const Safetensors* weights) const {
    std::vector<std::byte> bytes = pack_tissue(character, tissue, weights);
    std::vector<pack::TierRecord> tiers =
        measured_tiers(LoadedPack::from_bytes(bytes, character.name), truths);
    return {std::move(bytes), std::move(tiers)};
  }
};

// With the weights, or without where they do not pay: beside an emulator, whose tier they share, what they
// have to beat is the emulator without them.
Measured where_it_pays(const Judge& judge, const Safetensors* weights, std::vector<std::string>& notes) {
  Measured with = judge.measure(weights);
  const double error = error_ratio_of(with.tiers, Tier::kNetwork);
  std::optional<Measured> without;
  if (judge.tissue.emulator) without = judge.measure(nullptr);
  const double base =
      without ? error_ratio_of(without->tiers, Tier::kNetwork) : error_ratio_of(with.tiers, Tier::kModal);
  if (error < (1 - kNetworkMargin) * base) return with;
  notes.push_back(
      network_note(error, base, without ? "that of the emulator without it" : "its modal base's"));
  return without ? std::move(*without) : judge.measure(nullptr);
}

// The pack with the errors of this character, and without a network that does not pay on it.
std::vector<std::byte> measured(const Recipe& recipe, const Safetensors* weights, bool keep_network,
                                Character& character, const CharacterTissue& tissue) {
  const std::vector<std::byte> whole = pack_tissue(character, tissue, weights);
  try {
    const LoadedPack pack = LoadedPack::from_bytes(whole, character.name);
    const ShortTruths truths = short_truths(character, tissue.layout, recipe, tissue.finest, pack.view());
    note_too_soft(tissue.layout, truths, character.notes);
    const Judge judge{character, tissue, truths};
    const auto [bytes, tiers] =
        weights && !keep_network ? where_it_pays(judge, weights, character.notes) : judge.measure(weights);
    if (tissue.emulator && !(error_ratio_of(tiers, Tier::kNetwork) < error_ratio_of(tiers, Tier::kModal)))
      character.notes.push_back(far_emulator_note(tiers));
    double least = std::numeric_limits<double>::infinity();
    for (const Tier tier : {Tier::kModal, Tier::kNetwork})
      least = std::fmin(least, error_ratio_of(tiers, tier));
    if (least >= 1 && std::isfinite(least)) character.notes.push_back(no_gain_note(least));
    return with_tiers(bytes, tiers);
  } catch (const std::runtime_error& problem) {
    const char* what = keep_network || !weights ? "errors are not measured: "
                                                : "errors are not measured, and a network is left out: ";
    character.notes.push_back(what + std::string(problem.what()));
    return pack_tissue(character, tissue, keep_network ? weights : nullptr);
  }
}

BadInput needs_emulator(const CharacterOptions& options) {
  return BadInput(options.recipe +
                  ": \"model\": \"deep_emulator\" needs the weights of a deep_emulator: give "
                  "--emulator W.safetensors");
}

// Weights that predict patches, where a region's recipe wants them. Before all that takes time.
std::optional<Safetensors> read_emulator(const CharacterOptions& options, const Recipe& recipe,
                                         const std::optional<Safetensors>& tissue) {
  if (!options.emulator.empty()) {
    Safetensors weights = read_safetensors(options.emulator);
    const float own = metadata_number(weights, "rate_hz", 0, 1, 1000);
    check_emulator(weights, tissue ? metadata_number(*tissue, "rate_hz", own, 1, 1000) : own);
    PackWriter unused(pack::FileKind::kCharacter);
    add_patch_network(weights, unused);
    return weights;
  }
  const bool wanted = std::ranges::any_of(
      recipe.regions, [&](const RegionRecipe& region) { return region.emulated.value_or(recipe.emulated); });
  if (wanted || (recipe.emulated && !recipe.states_regions)) throw needs_emulator(options);
  return {};
}

void note_emulator(const CharacterOptions& options, CharacterTissue& tissue, const Safetensors& weights,
                   std::vector<std::string>& notes) {
  if (std::ranges::any_of(tissue.layout.regions, &Region::emulated))
    tissue.emulator = &weights;
  else
    notes.push_back("no region's recipe says \"model\": \"deep_emulator\": " + options.emulator +
                    " is not used");
}

// Weights that rods may start from. Before all that takes time.
std::optional<Safetensors> read_rod_weights(const CharacterOptions& options, const Recipe& recipe) {
  if (!options.rods.empty()) {
    Safetensors weights = read_safetensors(options.rods);
    PackWriter unused(pack::FileKind::kCharacter);
    add_rod_network(weights, unused);
    return weights;
  }
  if (!recipe.rods) return {};
  const auto learned = std::ranges::find_if(*recipe.rods, &RodRecipe::learned_start);
  if (learned != recipe.rods->end())
    throw BadInput(options.recipe + ": rod '" + learned->name +
                   "': \"start\": \"learned\" needs the weights of a coping_net: give --rods W.safetensors");
  return {};
}

// What becomes of them.
void note_rod_weights(const CharacterOptions& options, const TissueLayout& layout,
                      std::vector<std::string>& notes) {
  const auto learned = std::ranges::count_if(layout.rods, &Rod::learned_start);
  if (layout.rods.empty())
    notes.push_back("nothing swings as a rod: " + options.rods + " is not used");
  else if (learned == 0)
    notes.push_back("no rod's recipe says \"start\": \"learned\": " + options.rods +
                    " is packed for instances that ask for it (RodWarmStart::kLearned)");
}

void run_character(const CharacterOptions& options) {
  refuse_directory(options.output);
  const Recipe recipe = options.recipe.empty() ? Recipe{} : read_recipe(options.recipe);
  std::optional<Safetensors> weights;
  if (!options.tissue.empty()) weights = read_safetensors(options.tissue);
  const std::optional<Safetensors> emulator = read_emulator(options, recipe, weights);
  const std::optional<Safetensors> rod_weights = read_rod_weights(options, recipe);
  std::optional<Progress> progress(std::in_place, "baking " + options.output, 10);
  Character character = import_character(options.character, recipe);
  progress->update(1);
  CharacterTissue tissue = make_tissue(character, recipe);
  progress->update(6);
  if (emulator)
    note_emulator(options, tissue, *emulator, character.notes);
  else if (std::ranges::any_of(tissue.layout.regions, &Region::emulated))
    throw needs_emulator(options);
  if (rod_weights) {
    tissue.rod_weights = &*rod_weights;
    note_rod_weights(options, tissue.layout, character.notes);
  }
  if (weights && (tissue.layout.regions.empty() ||
                  (tissue.emulator && std::ranges::all_of(tissue.layout.regions, &Region::emulated)))) {
    check_model(*weights);
    character.notes.push_back(
        (tissue.emulator ? "all soft tissue is emulated: " : "nothing is soft tissue: ") + options.tissue +
        " is not used");
    weights.reset();
  }
  lower_limits(character, tissue);
  const Safetensors* network = weights ? &*weights : nullptr;
  const std::vector<std::byte> bytes =
      options.quick || !tissue.truth ? pack_tissue(character, tissue, network)
                                     : measured(recipe, network, options.keep_network, character, tissue);
  const LoadedPack pack =
      LoadedPack::from_bytes(bytes, options.character);  // what the runtime would refuse is not written
  if (!options.quick)
    for (std::string& warning : quick_audit({pack.view(), pack.bytes()}).failures)
      character.notes.push_back("audit: " + std::move(warning));
  if (rod_weights)
    for (std::string& note : notes_of_untrained_rods(*rod_weights, pack.view()))
      character.notes.push_back(std::move(note));
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
  command->add_option("--recipe", options->recipe, "JSON; see baker/mesh/recipe/recipe.hpp");
  command->add_option("--tissue", options->tissue, "trained weights, safetensors; without: modes only");
  command->add_option(
      "--emulator", options->emulator,
      "weights of a deep_emulator, safetensors, for regions whose recipe says \"model\": \"deep_emulator\"");
  command->add_option(
      "--rods", options->rods,
      "weights of a coping_net, safetensors, for rods whose recipe says \"start\": \"learned\"");
  command->add_flag("--quick", options->quick,
                    "does not measure errors against ground truth, nor whether the network pays: for trying");
  command->add_flag("--keep-network", options->keep_network,
                    "packs the network whatever its error is; sinew-train has judged it on more motions");
  add_output(*command, "-o,--output", options->output, "C.sinew")->required();
  add_output(*command, "--preview", options->preview, "picture of what moves by itself, .png");
  command->callback([options] { run_character(*options); });
}

}  // namespace sinew::baker
