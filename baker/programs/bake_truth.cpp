// bake_truth.cpp  sinew-bake truth: simulates a character's soft tissue and writes a trajectory.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/safetensors.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/common/progress.hpp"
#include "baker/mesh/recipe/import_character.hpp"
#include "baker/programs/commands.hpp"
#include "baker/truth/trajectory.hpp"
#include "baker/truth/voxel_nodes.hpp"

namespace sinew::baker {
namespace {

struct TruthOptions {
  std::string input, recipe, motion, output;
  std::vector<std::string> held_out;
  uint64_t seed = 0;
  double strength = 1, seconds = 4, rate_hz = 60;
  std::optional<int> substeps;
  bool surface = false, positions = false;
};

const Clip& find_clip(const Character& character, const std::string& name, const std::string& file) {
  std::string known;
  for (const Clip& clip : character.clips) {
    if (clip.name == name) return clip;
    known += (known.empty() ? "" : ", ") + clip.name;
  }
  throw BadInput(file + ": no clip '" + name + "'; it has " +
                 (known.empty() ? "none, use --motion shake" : known));
}

Motion make_motion(const Character& character, const TruthOptions& options) {
  if (options.motion.starts_with("clip:"))
    return clip_motion(character, find_clip(character, options.motion.substr(5), options.input), options.seed,
                       options.strength);
  if (options.motion == "shake") return shake_motion(character, options.seed, options.strength);
  for (const std::string& name : options.held_out) find_clip(character, name, options.input);
  if (options.motion == "random")
    return random_motion(character, options.seed, options.strength, options.held_out);
  if (options.motion == "leap")
    return leap_motion(character, options.seed, options.strength, options.held_out);
  throw BadInput("--motion " + options.motion + ": unknown; use clip:NAME, shake, random or leap");
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ",") + name;
  return out;
}

std::map<std::string, std::string> describe(const TruthOptions& options, const Character& character,
                                            const TissueLayout& layout) {
  std::vector<std::string> regions;
  for (const Region& region : layout.regions) regions.push_back(region.name);
  return {{"character", character.name},
          {"motion", options.motion},
          {"held_out", joined(options.held_out)},
          {"seed", std::to_string(options.seed)},
          {"strength", number(options.strength)},
          {"rate_hz", number(options.rate_hz)},
          {"substeps", std::to_string(*options.substeps)},
          {"seconds", number(options.seconds)},
          {"height_m", number(height_m(character))},
          {"regions", joined(regions)}};
}

void require(bool good, const char* option, double value, const char* range) {
  if (!good) throw BadInput(std::string(option) + " " + number(value) + ": must be " + range);
}

void run_truth(TruthOptions options) {
  require(options.seconds > 0 && options.seconds <= 3600, "--seconds", options.seconds,
          "above 0, at most 3600");
  require(options.rate_hz >= 10 && options.rate_hz <= 240, "--rate", options.rate_hz, "10 to 240");
  if (const int s = options.substeps.value_or(1); s < 1 || s > 64) require(false, "--substeps", s, "1 to 64");
  require(options.strength > 0 && options.strength <= 10, "--strength", options.strength,
          "above 0, at most 10");
  refuse_directory(options.output);

  const Recipe recipe = options.recipe.empty() ? Recipe{} : read_recipe(options.recipe);
  Character character = import_character(options.input, recipe);
  const TissueLayout layout = layout_to_bake(character, recipe);
  if (layout.regions.empty())
    throw BadInput(options.input +
                   ": no part is soft tissue, which is what this simulates; name soft bones in a recipe's "
                   "\"regions\" or paint _STIFFNESS");
  const Motion motion = make_motion(character, options);

  TissueTruth truth(character, layout, recipe);
  const std::vector<ModalBasis> modes = truth.modal_bases(layout, kMostModes);
  if (!options.substeps) options.substeps = usual_substeps(modes, options.rate_hz);
  TrajectoryRecorder recorder(character, layout, {options.rate_hz, options.surface, options.positions},
                              modes);
  const auto ticks = static_cast<size_t>(std::lround(options.seconds * options.rate_hz));
  Progress progress("truth " + options.motion, ticks);
  recorder.add(truth.start(motion));
  for (size_t tick = 1; tick <= ticks; ++tick) {
    recorder.add(truth.advance(options.rate_hz, *options.substeps));
    progress.update(tick);
  }
  write_safetensors(options.output, recorder.finish(describe(options, character, layout)));
}

}  // namespace

void add_truth_command(CLI::App& app, int*) {
  auto options = std::make_shared<TruthOptions>();
  CLI::App* command = app.add_subcommand("truth", "Simulates soft tissue by FEM and writes a trajectory");
  command->add_option("character", options->input, "skinned glTF or VRM")->required();
  command->add_option("--recipe", options->recipe, "JSON; see baker/mesh/recipe/recipe.hpp");
  command->add_option("--motion", options->motion, "clip:NAME, shake, random or leap")->required();
  command
      ->add_option("--hold-out", options->held_out,
                   "a clip that random motions and leaps must not use; repeatable")
      ->allow_extra_args(false);
  command->add_option("--seed", options->seed, "variant of the motion; a clip's seed 0 is the clip as it is");
  command->add_option("--strength", options->strength,
                      "of the motion's accelerations; a clip's, by its speed");
  command->add_option("--seconds", options->seconds, "simulated time");
  command->add_option("--rate", options->rate_hz, "ticks a second");
  command->add_option("--substeps", options->substeps,
                      "steps a tick; by default 80 a period of the fastest soft part, 240 to 480 a second");
  command->add_flag("--surface", options->surface,
                    "also the displacement of every embedded vertex, and the embedding weights");
  command->add_flag("--positions", options->positions, "also the true position of every vertex");
  add_output(*command, "-o,--output", options->output, "trajectory, safetensors")->required();
  command->callback([options] { run_truth(*options); });
}

}  // namespace sinew::baker
