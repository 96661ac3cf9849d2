// propose.cpp  A proposal is a recipe: unedited it bakes what no recipe bakes, and what is in doubt is off.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "baker/common/files/read_file.hpp"
#include "baker/common/files/write_file.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/bake.hpp"

using namespace sinew::baker;
using namespace sinew::test;

namespace {

constexpr double kThreeDigits = 0.005;  // to which a proposal states its numbers

std::string character_file(const std::string& name) {
  const std::string path = SINEW_SHARED_DIR "/characters/" + name;
  if (std::filesystem::exists(path)) return path;
  WARN("skipped: " << path << " is not there (CMake variable SINEW_SHARED_DIR)");
  return "";
}

nlohmann::json proposal_of(const std::string& file, const std::string& recipe) {
  must(bake({"propose", file, "-o", recipe}));
  return nlohmann::json::parse(read_text(recipe));
}

nlohmann::json baked(const std::string& file, const std::string& recipe, const std::string& pack) {
  std::vector<std::string> arguments = {"character", file, "--quick", "-o", pack};
  if (!recipe.empty()) arguments.insert(arguments.end(), {"--recipe", recipe});
  must(bake(arguments));
  return nlohmann::json::parse(bake({"info", "--json", pack}).out);
}

// Parts of both packs in one order, with the same motion.
void check_same_parts(const nlohmann::json& a, const nlohmann::json& b) {
  for (const char* list : {"regions", "rods"}) {
    REQUIRE(a.contains(list) == b.contains(list));
    if (!a.contains(list)) continue;
    REQUIRE(a[list].size() == b[list].size());
    for (size_t i = 0; i < a[list].size(); ++i) {
      INFO(a[list][i]["name"]);
      CHECK(a[list][i]["name"] == b[list][i]["name"]);
      for (const auto& [key, value] : a[list][i].items())
        if (value.is_number_float())
          CHECK(value.get<double>() ==
                Approx(b[list][i][key].get<double>()).epsilon(kThreeDigits).margin(1e-6));
    }
  }
}

std::set<std::string> switched_on(const nlohmann::json& proposal) {
  std::set<std::string> names;
  for (const char* list : {"regions", "rods"})
    for (const auto& part : proposal.value(list, nlohmann::json::array()))
      if (part["enabled"]) names.insert(part["name"].get<std::string>());
  return names;
}

}  // namespace

TEST_CASE("a_proposal_refuses_what_it_cannot_read_or_write") {
  const TemporaryFolder folder;
  const std::string glb = folder.file("c.glb");
  check_refused({"propose", "/nowhere/c.glb", "-o", folder.file("r.json")}, {"/nowhere/c.glb"});
  write_file(glb, std::string_view("GIF89a, and more"));
  check_refused({"propose", glb, "-o", folder.file("r.json")}, {"c.glb", "not a glTF file"});
  check_refused({"propose", glb, "-o", glb}, {"c.glb"});
  check_refused({"propose", glb, "-o", folder.path()}, {folder.path()});
  CHECK(folder.entries() == 1);
}

TEST_CASE("a_proposal_reads_a_file_as_a_recipe_says_and_says_so_too") {
  const TemporaryFolder folder;
  const std::string glb = folder.file("c.glb"), recipe = folder.file("r.json");
  must(bake({"creature", SINEW_SOURCE_DIR "/assets/creature/creature.json", "-o", glb, "--vertices", "800"}));
  write_file(recipe, std::string_view(R"({"unit_m": 0.1})"));
  must(bake({"propose", glb, "--recipe", recipe, "-o", folder.file("p.json")}));
  CHECK(nlohmann::json::parse(read_text(folder.file("p.json")))["unit_m"] == 0.1);
  check_refused({"propose", glb, "--recipe", recipe, "-o", recipe}, {"r.json"});
}

TEST_CASE("painted_parts_are_proposed_by_name_and_bake_as_painted") {
  const TemporaryFolder folder;
  const std::string glb = folder.file("c.glb"), recipe = folder.file("r.json");
  must(bake({"creature", SINEW_SOURCE_DIR "/assets/creature/creature.json", "-o", glb, "--vertices", "800"}));
  const nlohmann::json proposal = proposal_of(glb, recipe);
  REQUIRE(proposal["regions"].size() >= 3);
  for (const auto& region : proposal["regions"]) {
    CHECK(region["enabled"] == true);
    CHECK_THAT(region["note"].get<std::string>(), Catch::Contains("painted"));
    CHECK(region.contains("frequency_hz"));
    CHECK(region.contains("max_displacement"));
  }
  const nlohmann::json by_paint = baked(glb, "", folder.file("a.sinew")),
                       by_proposal = baked(glb, recipe, folder.file("b.sinew"));
  check_same_parts(by_paint, by_proposal);
}

TEST_CASE("shared_a_proposal_unedited_bakes_what_no_recipe_bakes") {
  for (const char* name : {"khronos_fox/file.glb", "godette_vrm0/file.vrm", "kaykit_mage/file.glb"}) {
    const std::string file = character_file(name);
    if (file.empty()) return;
    INFO(name);
    const TemporaryFolder folder;
    proposal_of(file, folder.file("r.json"));
    check_same_parts(baked(file, "", folder.file("a.sinew")),
                     baked(file, folder.file("r.json"), folder.file("b.sinew")));
  }
}

TEST_CASE("shared_what_is_in_doubt_is_proposed_switched_off_with_its_reason_and_bakes_once_it_is_on") {
  const std::string file = character_file("khronos_cesium_man/file.glb");
  if (file.empty()) return;
  const TemporaryFolder folder;
  nlohmann::json proposal = proposal_of(file, folder.file("r.json"));
  REQUIRE(!proposal["regions"].empty());
  for (const auto& region : proposal["regions"]) {
    CHECK(region["enabled"] == false);
    CHECK_THAT(region["note"].get<std::string>(), Catch::Contains("in doubt: "));
    CHECK(region["frequency_hz"].get<double>() > 0);
  }
  CHECK(baked(file, folder.file("r.json"), folder.file("off.sinew"))
            .value("regions", nlohmann::json())
            .empty());
  CHECK(proposal["regions"][0]["name"] == "belly");
  proposal["regions"][0]["enabled"] = true;
  write_file(folder.file("r.json"), std::string_view(proposal.dump()));
  CHECK(baked(file, folder.file("r.json"), folder.file("on.sinew"))["regions"][0]["name"] == "belly");
  for (auto& region : proposal["regions"]) region["enabled"] = true;
  write_file(folder.file("r.json"), std::string_view(proposal.dump()));
  baked(file, folder.file("r.json"), folder.file("all.sinew"));
  CHECK(bake({"audit", folder.file("all.sinew")}).exit_code == 0);  // their limits keep the skin whole
}

TEST_CASE("made_up_characters_have_switched_on_what_an_artist_would_and_nothing_hard") {
  const TemporaryFolder folder;
  const ProgramResult made =
      run_program({SINEW_PYTHON, "-B", SINEW_SOURCE_DIR "/assets/gallery/made_up.py", folder.path()});
  if (made.error.find("numpy") != std::string::npos) {
    WARN("skipped: " SINEW_PYTHON " has no numpy");
    return;
  }
  INFO(made.error);
  REQUIRE(made.exit_code == 0);
  const std::vector<std::pair<std::string, std::set<std::string>>> characters = {
      {"cow", {"belly", "tail_01", "ear_01_l", "ear_01_r"}},
      {"witch", {"Witch_Hat", "Witch_Hair", "Witch_Cape"}},
      {"knight", {}},
      {"ogre", {"belly", "Ogre_Beard"}}};
  for (const auto& [name, expected] : characters) {
    INFO(name);
    CHECK(switched_on(proposal_of(folder.file(name + ".glb"), folder.file(name + ".json"))) == expected);
  }
}
