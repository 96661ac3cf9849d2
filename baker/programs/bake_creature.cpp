// bake_creature.cpp  sinew-bake creature: makes a character from its recipe as a glTF binary.
#include <memory>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/creature/creature.hpp"
#include "baker/programs/commands.hpp"

namespace sinew::baker {
namespace {

struct CreatureOptions {
  std::string recipe, output;
  size_t vertices = 0;
};

void run_creature(const CreatureOptions& options, bool vertices_given) {
  if (vertices_given &&
      (options.vertices < kFewestCreatureVertices || options.vertices > kMostCreatureVertices))
    throw BadInput("--vertices " + std::to_string(options.vertices) + ": must be from 200 to 50000");
  write_file(options.output, make_creature(read_creature_recipe(options.recipe), options.vertices));
}

}  // namespace

void add_creature_command(CLI::App& app, int*) {
  auto options = std::make_shared<CreatureOptions>();
  CLI::App* command = app.add_subcommand("creature", "Makes a character from a recipe");
  command->add_option("recipe", options->recipe, "JSON; see assets/creature/README.md")->required();
  CLI::Option* vertices = command->add_option("--vertices", options->vertices,
                                              "about so many, 200 to 50000; the recipe's own by default");
  add_output(*command, "-o,--output", options->output, "C.glb")->required();
  command->callback([options, vertices] { run_creature(*options, vertices->count() > 0); });
}

}  // namespace sinew::baker
