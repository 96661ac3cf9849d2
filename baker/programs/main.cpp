// sinew-bake  Everything that happens before a game runs: see `sinew-bake --help`.
#include <cstdio>
#include <exception>

#include "baker/common/bad_input.hpp"
#include "baker/programs/commands.hpp"

int main(int argc, char** argv) {
  using namespace sinew::baker;
  CLI::App app{"Bakes characters and trained weights into .sinew files."};
  app.require_subcommand(1);
  int exit_code = 0;

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const BadInput& error) {
    std::fprintf(stderr, "sinew-bake: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sinew-bake: internal error: %s\n", error.what());
    return 2;
  }
  return exit_code;
}
