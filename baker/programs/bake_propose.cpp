// bake_propose.cpp  sinew-bake propose: what may swing of a character, as a recipe to edit and a picture.
#include <cstdio>
#include <memory>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/common/progress.hpp"
#include "baker/common/write_file.hpp"
#include "baker/mesh/import_character.hpp"
#include "baker/mesh/proposal.hpp"
#include "baker/preview/write_preview.hpp"
#include "baker/programs/character_tissue.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/loaded_pack.hpp"

namespace sinew::baker {
namespace {

struct ProposeOptions {
  std::string character, output, preview;
};

// Numbers of what is in doubt, from a layout in which it is soft beside what is certain. What has nothing
// soft even so is no candidate.
void try_doubtful(const Character& character, Proposal& proposal) {
  std::vector<Candidate> certain, doubtful;
  for (Candidate& part : proposal.regions)
    (part.doubt.empty() ? certain : doubtful).push_back(std::move(part));
  proposal.regions = certain;
  for (Candidate& part : doubtful) {
    std::vector<Candidate> with = certain;
    with.push_back(part);
    Character copy = character;
    try {
      state_numbers(layout_tissue(copy, recipe_of(with, proposal.rods)), static_cast<int>(certain.size()),
                    part.region);
      proposal.regions.push_back(std::move(part));
    } catch (const BadInput&) {
    }
  }
}

std::string caption(size_t number, bool enabled) {
  return std::to_string(number) + (enabled ? "" : " (off)");
}

// All parts, those in doubt too, with their numbers in the recipe.
void draw(const ProposeOptions& options, const Character& character, const Proposal& proposal) {
  Character copy = character;
  const CharacterTissue all = make_tissue(copy, recipe_of(proposal.regions, proposal.rods));
  const LoadedPack pack = LoadedPack::from_bytes(pack_tissue(copy, all, nullptr), options.character);
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
  std::optional<Progress> progress(std::in_place, "looking at " + options.character, 4);
  const Character character = import_character(options.character, {});
  progress->update(1);
  Character certain = character;
  CharacterTissue tissue = make_tissue(certain, {});
  lower_limits(certain, tissue);
  progress->update(2);
  Proposal proposal = propose(certain, tissue.layout);
  try_doubtful(character, proposal);
  progress->update(3);
  if (!options.preview.empty()) draw(options, character, proposal);
  write_file(options.output, proposal_text(proposal, options.character));
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
  add_output(*command, "-o,--output", options->output, "R.json")->required();
  add_output(*command, "--preview", options->preview, "picture of the parts with their numbers, .png");
  command->callback([options] { run_propose(*options); });
}

}  // namespace sinew::baker
