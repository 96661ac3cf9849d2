// nasty_files.cpp  Files that other importers stumbled over: each one is imported, or refused by one line.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "baker/common/bad_input.hpp"
#include "baker/import/import_gltf.hpp"

using namespace sinew::baker;
namespace fs = std::filesystem;

namespace {

const fs::path kNasty = SINEW_SHARED_DIR "/nasty_gltf";

std::vector<std::string> files_under(const fs::path& folder) {
  std::vector<std::string> files;
  if (!fs::exists(folder))
    WARN("skipped: no " + folder.string() + "; set SINEW_SHARED_DIR");
  else
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
        files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

// "imported", or the refusal without the path.
std::string outcome(const std::string& path) {
  try {
    const Character character = import_gltf(path);
    for (const Vector3& place : skin_positions(character, joint_matrices(character, nullptr, 0)))
      CHECK(place.allFinite());
    return "imported";
  } catch (const BadInput& error) {
    const std::string line = error.what();
    CHECK(line.find('\n') == std::string::npos);
    CHECK(line.find(path + ": ") == 0);
    return line.substr(path.size() + 2);
  }
}

bool has_skin(const std::string& path) {
  std::ifstream stream(path);
  const nlohmann::json json = nlohmann::json::parse(stream);
  return json.contains("skins");
}

}  // namespace

TEST_CASE("every_nasty_file_is_imported_or_refused_by_one_line") {
  std::map<std::string, int> table;
  for (const std::string& path : files_under(kNasty)) {
    INFO(path);
    ++table[outcome(path)];
  }
  for (const auto& [line, count] : table) std::cout << count << " x " << line << "\n";
}

TEST_CASE("valid_files_with_a_skin_are_imported_and_those_without_are_refused_for_that") {
  for (const std::string& path : files_under(kNasty / "gltf_asset_generator/Positive")) {
    const std::string line = outcome(path);
    INFO(path << ": " << line);
    if (has_skin(path))
      CHECK(line == "imported");
    else
      CHECK(line.find("this file has no skin") == 0);
  }
}

TEST_CASE("files_that_are_wrong_are_not_imported") {
  for (const std::string& path : files_under(kNasty / "gltf_asset_generator/Negative")) {
    INFO(path);
    CHECK(outcome(path) != "imported");
  }
}
