// bake_propose.cpp  sinew-bake propose: what may swing of a character, as a recipe to edit and a picture.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/common/progress.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/mesh/parts/proposal.hpp"
#include "baker/mesh/recipe/import_character.hpp"
#include "baker/preview/write_preview.hpp"
#include "baker/programs/character_tissue.hpp"
#include "baker/programs/commands.hpp"

namespace sinew::baker {
namespace {

struct ProposeOptions {
  std::string character, recipe, output, preview;
};

// Of a recipe, how it reads a file.
Recipe reading_of(const std::string& path) {
  Recipe reading;
  if (path.empty()) return reading;
  const Recipe given = read_recipe(path);
  reading.unit_m = given.unit_m;
  reading.up = given.up;
  reading.without_meshes = given.without_meshes;
  reading.with_meshes = given.with_meshes;
  return reading;
}

bool lays_out(const Character& character, const Recipe& recipe) {
  Character copy = character;
  try {
    layout_tissue(copy, recipe);
    return true;
  } catch (const BadInput&) {
    return false;
  }
}

// What has nothing soft beside the parts before it is no candidate.
void drop_rigid(const Character& character, Proposal& proposal) {
  if (lays_out(character, recipe_of(proposal.regions, proposal.rods))) return;
  std::vector<Candidate> kept;
  for (Candidate& part : proposal.regions) {
    kept.push_back(std::move(part));
    if (!kept.back().doubt.empty() && !lays_out(character, recipe_of(kept, proposal.rods))) kept.pop_back();
  }
  proposal.regions = std::move(kept);
}

// All parts at once: what is in doubt has its numbers beside all others, with limits that keep its skin
// whole.
CharacterTissue switch_all_on(const Character& character, Proposal& proposal) {
  Character copy = character;
  CharacterTissue all = make_tissue(copy, recipe_of(proposal.regions, proposal.rods));
  lower_limits(copy, all);
  for (size_t part = 0; part < proposal.regions.size(); ++part)
    if (!proposal.regions[part].doubt.empty())
      state_numbers(all.layout, static_cast<int>(part), proposal.regions[part].region);
  return all;
}

std::string caption(size_t number, bool enabled) {
  return std::to_string(number) + (enabled ? "" : " (off)");
}

// All parts, those in doubt too, with their numbers in the recipe.
void draw(const ProposeOptions& options, const Character& character, const Proposal& proposal,
          const CharacterTissue& all) {
  const LoadedPack pack = LoadedPack::from_bytes(pack_tissue(character, all, nullptr), options.character);
  std::vector<std::string> captions;
  for (const Region& region : all.layout.regions) {
    const auto part = static_cast<size_t>(std::max(0, region.recipe_region));
    captions.push_back(caption(part + 1, proposal.regions[part].doubt.empty()));
  }
  for (const Rod& rod : all.layout.rods)
    for (size_t r = 0; r < proposal.rods.size(); ++r)
      if (proposal.rods[r].rod.name == rod.name)
        captions.push_back(caption(proposal.regions.size() + r + 1, true));
  write_preview(options.preview, pack.view(), captions);
}

void print_summary(const ProposeOptions& options, const Proposal& proposal) {
  size_t count = 0;
  for (const Candidate& part : proposal.regions)
    std::printf("%2zu %-3s %-20s %s%s\n", ++count, part.doubt.empty() ? "on" : "off",
                part.region.name.c_str(), part.why.c_str(),
                part.doubt.empty() ? "" : ("; in doubt: " + part.doubt).c_str());
  for (const ProposedRod& rod : proposal.rods)
    std::printf("%2zu on  %-20s %s\n", ++count, rod.rod.name.c_str(), rod.why.c_str());
  if (count == 0) std::printf("nothing of it may swing\n");
  std::printf("%s: %zu parts; edit it, then: sinew-bake character %s --recipe %s -o C.sinew\n",
              options.output.c_str(), count, options.character.c_str(), options.output.c_str());
}

void run_propose(const ProposeOptions& options) {
  refuse_directory(options.output);
  if (!options.preview.empty()) refuse_directory(options.preview);
  const Recipe reading = reading_of(options.recipe);
  std::optional<Progress> progress(std::in_place, "looking at " + options.character, 4);
  const Character character = import_character(options.character, reading);
  progress->update(1);
  Character certain = character;
  CharacterTissue tissue = make_tissue(certain, {});
  lower_limits(certain, tissue);
  progress->update(2);
  Proposal proposal = propose(certain, tissue.layout);
  drop_rigid(character, proposal);
  const CharacterTissue all = switch_all_on(character, proposal);
  progress->update(3);
  if (!options.preview.empty()) draw(options, character, proposal, all);
  write_file(options.output, proposal_text(proposal, reading, options.character));
  progress.reset();
  for (const std::string& note : certain.notes) std::printf("note: %s\n", note.c_str());
  print_summary(options, proposal);
}

}  // namespace

void add_propose_command(CLI::App& app, int*) {
  auto options = std::make_shared<ProposeOptions>();
  CLI::App* command = app.add_subcommand(
      "propose", "Writes a recipe of all that may swing of a character, to edit and to bake it by");
  command->add_option("character", options->character, "skinned glTF or VRM")->required();
  command->add_option("--recipe", options->recipe,
                      "JSON that says how to read the file: unit_m, up, without_meshes, with_meshes");
  add_output(*command, "-o,--output", options->output, "R.json")->required();
  add_output(*command, "--preview", options->preview, "picture of the parts with their numbers, .png");
  command->callback([options] { run_propose(*options); });
}

}  // namespace sinew::baker
