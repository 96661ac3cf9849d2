// run_program.hpp  Runs a program and takes what it says.
#pragma once
#include <string>
#include <vector>

namespace sinew::test {

struct ProgramResult {
  int exit_code = -1;  // -1: it did not end by itself
  std::string out, error;
};

// arguments[0] is the program's path. No shell: arguments are passed as they are.
ProgramResult run_program(const std::vector<std::string>& arguments);

}  // namespace sinew::test
