// sinew-bake  Everything that happens before a game runs: see `sinew-bake --help`.
#include <cstdio>
#include <exception>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/programs/commands.hpp"

namespace {

constexpr int kUnusableInput = 2;

int refuse(std::string message) {
  for (char& c : message)
    if (c == '\n') c = ' ';
  std::fprintf(stderr, "sinew-bake: %s\n", message.c_str());
  return kUnusableInput;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace sinew::baker;
  CLI::App app{"Bakes characters and trained weights into .sinew files."};
  app.require_subcommand(1);
  int exit_code = 0;
  add_creature_command(app, &exit_code);
  add_character_command(app, &exit_code);
  add_model_command(app, &exit_code);
  add_check_command(app, &exit_code);
  add_info_command(app, &exit_code);
  add_judge_command(app, &exit_code);
  add_rod_data_command(app, &exit_code);
  add_truth_command(app, &exit_code);
  const auto is_named = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(is_named).empty())
    return refuse(std::string("no command '") + argv[1] + "'; see sinew-bake --help");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return refuse(std::string(error.what()) + "; see sinew-bake --help");
  } catch (const BadInput& error) {
    return refuse(error.what());
  } catch (const std::bad_alloc&) {
    return refuse("out of memory; the input is too large for this machine");
  } catch (const std::exception& error) {
    return refuse(std::string("internal error: ") + error.what());
  }
  return exit_code;
}
