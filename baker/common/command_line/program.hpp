// program.hpp  How a program ends: its own code, or 2 and one line on standard error.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/common/command_line/input_files.hpp"

namespace sinew::baker {

inline constexpr int kUnusableInput = 2;

inline int refuse(const char* program, std::string message) {
  for (char& c : message)
    if (c == '\n') c = ' ';
  std::fprintf(stderr, "%s: %s\n", program, message.c_str());
  return kUnusableInput;
}

// Parses, then does work(), which returns the exit code. Outputs that are inputs are refused before.
template <class Work>
int run_program(const char* program, CLI::App& app, int argc, char** argv, Work work) {
  try {
    keep_inputs(app);
    app.parse(argc, argv);
    return work();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return refuse(program, std::string(error.what()) + "; see " + program + " --help");
  } catch (const BadInput& error) {
    return refuse(program, error.what());
  } catch (const std::bad_alloc&) {
    return refuse(program, "out of memory; the input is too large for this machine");
  } catch (const std::exception& error) {
    return refuse(program, std::string("internal error: ") + error.what());
  }
}

}  // namespace sinew::baker
