// sinew-bake  Everything that happens before a game runs: see `sinew-bake --help`.
#include <string>

#include "baker/common/command_line/program.hpp"
#include "baker/programs/commands.hpp"

int main(int argc, char** argv) {
  using namespace sinew::baker;
  CLI::App app{"Bakes characters and trained weights into .sinew files."};
  app.require_subcommand(1);
  app.footer(
      "  sinew-bake propose IN.glb -o R.json --preview parts.png      what may swing, as a recipe to edit\n"
      "  sinew-bake character IN.glb -o C.sinew --preview parts.png   a character, and a picture of its soft "
      "parts\n"
      "  sinew-bake info C.sinew                                      what is inside\n"
      "Each command explains itself: sinew-bake COMMAND --help. The path from a file to a game: "
      "baker/README.md");
  int exit_code = 0;
  add_creature_command(app, &exit_code);
  add_character_command(app, &exit_code);
  add_propose_command(app, &exit_code);
  add_model_command(app, &exit_code);
  add_check_command(app, &exit_code);
  add_info_command(app, &exit_code);
  add_judge_command(app, &exit_code);
  add_audit_command(app, &exit_code);
  add_patch_data_command(app, &exit_code);
  add_rod_data_command(app, &exit_code);
  add_truth_command(app, &exit_code);
  const auto is_named = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(is_named).empty())
    return refuse("sinew-bake", std::string("no command '") + argv[1] + "'; see sinew-bake --help");
  return run_program("sinew-bake", app, argc, argv, [&] { return exit_code; });
}
