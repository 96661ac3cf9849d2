// bake.hpp  sinew-bake as the tests call it.
#pragma once
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/baker/programs/run_program.hpp"

namespace sinew::test {

inline ProgramResult bake(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SINEW_BAKE);
  return run_program(arguments);
}

inline void must(const ProgramResult& result) {
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
}

// Exit code 2, one line on stderr that holds `words`, nothing on stdout.
inline void check_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
  const ProgramResult result = bake(arguments);
  INFO(result.error);
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK_THAT(result.error, Catch::StartsWith("sinew-bake: "));
  CHECK(result.error.find('\n') == result.error.size() - 1);
  for (const std::string& word : words) CHECK_THAT(result.error, Catch::Contains(word));
}

// A file of the reference data; null if the data are not there, which is said once.
inline std::string golden(const std::string& name) {
  const std::string path = SINEW_SHARED_DIR "/golden/" + name;
  if (std::filesystem::exists(path)) return path;
  WARN("skipped: " << path << " is not there (CMake variable SINEW_SHARED_DIR)");
  return "";
}

}  // namespace sinew::test
