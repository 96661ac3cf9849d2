// bake_character.cpp  sinew-bake character: a skinned character, its modes and trained weights to one .sinew
// file.
#include <cstdio>
#include <memory>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/common/write_file.hpp"
#include "baker/import/import_gltf.hpp"
#include "baker/mesh/tissue_layout.hpp"
#include "baker/pack/character_pack.hpp"
#include "baker/programs/calibrate.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/describe.hpp"
#include "baker/truth/tissue_truth.hpp"

namespace sinew::baker {
namespace {

struct CharacterOptions {
  std::string character, recipe, tissue, output, precision = "fp32";
  std::vector<std::string> calibration;
};

Character import_character(const CharacterOptions& options, const Recipe& recipe) {
  ImportOptions import;
  import.unit_m = recipe.unit_m;
  import.up = recipe.up;
  return import_gltf(options.character, import);
}

void print_summary(const CharacterOptions& options, const Character& character, const LoadedPack& pack) {
  for (const std::string& note : character.notes) std::printf("note: %s\n", note.c_str());
  for (const std::string& note : notes_on(pack.view())) std::printf("note: %s\n", note.c_str());
  nlohmann::ordered_json description = describe_pack(pack);
  for (const char* detail : {"network", "metadata"}) description.erase(detail);  // `info` shows them
  std::printf("%s: %s", options.output.c_str(), format_description(description).c_str());
}

pack::Precision precision_of(const CharacterOptions& options) {
  const pack::Precision precision = parse_precision(options.precision);
  check_calibration(precision, !options.calibration.empty());
  if (precision != pack::Precision::kFloat32 && options.tissue.empty())
    throw BadInput("--precision " + options.precision +
                   ": is a network's, and there is no --tissue; leave it out or give weights");
  return precision;
}

// A file of trajectories; else of vectors.
bool holds_motion(const std::string& path) {
  return read_safetensors(path).metadata.contains("sinew.trajectory");
}

// floats: the character in float32.
std::vector<HeardRanges> int8_ranges(const CharacterOptions& options, const Safetensors& weights,
                                     const std::vector<std::byte>& floats) {
  const std::vector<std::string>& files = options.calibration;
  if (!files.empty() && holds_motion(files.front()))
    return heard_ranges(LoadedPack::from_bytes(floats, options.character), files);
  if (files.size() > 1)
    throw BadInput("--calibrate " + files.front() +
                   ": is of vectors, of which one file is taken; give true "
                   "motions, or it alone");
  return widened(ranges_for(weights, pack::Precision::kInt8, files.empty() ? "" : files.front()),
                 kBeyondVectors);
}

struct Bases {
  std::vector<ModalBasis> finest;
  std::vector<GraphLevel> coarser;
};

// A character of rods alone has no tissue.
Bases modal_bases(const Character& character, const TissueLayout& layout, const Recipe& recipe) {
  if (layout.regions.empty()) return {};
  TissueTruth truth(character, layout, recipe);
  Bases bases{truth.modal_bases(layout, kMostModes), {}};
  bases.coarser = coarser_levels(character, recipe, truth, layout, bases.finest);
  return bases;
}

void run_character(const CharacterOptions& options) {
  const pack::Precision precision = precision_of(options);
  const Recipe recipe = options.recipe.empty() ? Recipe{} : read_recipe(options.recipe);
  std::optional<Safetensors> weights;
  if (!options.tissue.empty()) weights = read_safetensors(options.tissue);
  Character character = import_character(options, recipe);
  const TissueLayout layout = layout_tissue(character, recipe);
  const Bases bases = modal_bases(character, layout, recipe);
  const auto packed = [&](pack::Precision in, std::span<const HeardRanges> ranges) {
    return pack_character(character, layout, bases.finest, weights ? &*weights : nullptr, in, ranges,
                          bases.coarser);
  };
  std::vector<HeardRanges> ranges;
  if (precision == pack::Precision::kInt8)
    ranges = int8_ranges(options, *weights, packed(pack::Precision::kFloat32, {}));
  const std::vector<std::byte> bytes = packed(precision, ranges);
  const LoadedPack pack =
      LoadedPack::from_bytes(bytes, options.character);  // what the runtime would refuse is not written
  write_file(options.output, bytes);
  print_summary(options, character, pack);
}

}  // namespace

void add_character_command(CLI::App& app, int*) {
  auto options = std::make_shared<CharacterOptions>();
  CLI::App* command =
      app.add_subcommand("character", "Packs a skinned character with its tissue's modes and network");
  command->add_option("character", options->character, "skinned glTF or VRM")->required();
  command->add_option("--recipe", options->recipe, "JSON; see baker/mesh/recipe.hpp");
  command->add_option("--tissue", options->tissue,
                      "trained weights, safetensors; without: tiers modal and spring only");
  add_precision_option(command, &options->precision);
  command
      ->add_option("--calibrate", options->calibration,
                   "true motions of this character (sinew-bake truth) that int8 takes its scales from, in "
                   "closed loop; or a file of vectors; by default those beside the weights, else a made-up "
                   "motion. Repeatable")
      ->allow_extra_args(false);
  command->add_option("-o,--output", options->output, "C.sinew")->required();
  command->callback([options] { run_character(*options); });
}

}  // namespace sinew::baker
