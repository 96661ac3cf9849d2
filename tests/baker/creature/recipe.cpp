// recipe.cpp  A creature's recipe is read as written, and every slip in it is named.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "baker/common/bad_input.hpp"
#include "creature_file.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew;
using baker::BadInput;
using nlohmann::json;

namespace {

std::string refusal_of_text(const std::string& text) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("creature.json");
  std::ofstream(path) << text;
  try {
    baker::read_creature_recipe(path);
  } catch (const BadInput& error) {
    const std::string line = error.what();
    CHECK(line.find(path) == 0);
    CHECK(line.find('\n') == std::string::npos);
    return line;
  }
  return "read";
}

// What is said when the shipped recipe is spoilt in one place.
std::string refusal(const std::function<void(json&)>& spoil) {
  json recipe = json::parse(std::ifstream(test::recipe_path()));
  spoil(recipe);
  return refusal_of_text(recipe.dump());
}

}  // namespace

TEST_CASE("wrong_creature_recipes_are_refused_by_place_and_key") {
  CHECK_THROWS_AS(baker::read_creature_recipe("/nowhere/creature.json"), BadInput);
  CHECK_THAT(refusal_of_text("{ bad"), Catch::Contains("not JSON"));
  CHECK_THAT(refusal_of_text("[1]"), Catch::Contains("object"));
  CHECK_THAT(refusal_of_text("{}"), Catch::Contains("\"name\" is missing"));

  const std::vector<std::pair<std::function<void(json&)>, std::string>> faults = {
      {[](json& r) { r["verticse"] = 1; }, "did you mean \"vertices\""},
      {[](json& r) { r["vertices"] = 100; }, "200 .. 50000"},
      {[](json& r) { r["joints"] = json::array(); }, "at least one joint"},
      {[](json& r) { r["joints"][3]["parent"] = "nobody"; }, "joints[3]: \"parent\""},
      {[](json& r) { r["joints"][2]["name"] = "pelvis"; }, "is taken"},
      {[](json& r) {
         r["joints"][1]["at"] = {0, 1};
       },
       "must be 3 numbers"},
      {[](json& r) { r["limbs"][0]["lower"] = "head"; }, "must be a child of"},
      {[](json& r) { r["body"][0]["radii"][1] = -1; }, "body[0]: \"radii\" holds -1"},
      {[](json& r) { r["body"][0]["joints"] = {"wing"}; }, "names \"wing\""},
      {[](json& r) { r["body"][0].erase("joints"); }, "at least one joint"},
      {[](json& r) { r["body"][0]["carve"] = true; }, "first part"},
      {[](json& r) { r["body"][3]["tube"][0][3] = 0; }, "radius"},
      {[](json& r) { r["body"][3]["tube"][1] = "x"; }, "tube[1]"},
      {[](json& r) { r["details"][0]["material"] = "glass"; }, "not in \"materials\""},
      {[](json& r) { r["details"][0]["bands"][0]["color"] = "red"; }, "#ff8040"},
      {[](json& r) { r["coat"][1]["strength"] = 2; }, "within 0 .. 1"},
      {[](json& r) { r["tissue"][0]["stiffness"] = "soft"; }, "must be a number"},
      {[](json& r) { r["stance"][0]["axis"] = "roll"; }, "move_x"},
      {[](json& r) { r["stance"][0]["mirror"] = "upside_down"; }, "half_cycle_later"},
      {[](json& r) { r["clips"][0]["duration_s"] = 0; }, "duration_s"},
      {[](json& r) {
         r["clips"][0]["tracks"][0]["wave"] = {1, 1.5, 0};
       },
       "whole cycles"},
      {[](json& r) {
         r["clips"][0]["tracks"][0]["keys"] = {{0.5, 1}, {0.2, 1}};
       },
       "ascending"},
  };
  for (const auto& [spoil, wanted] : faults) CHECK_THAT(refusal(spoil), Catch::Contains(wanted));
}

TEST_CASE("mirrored_halves_are_written_out") {
  const baker::CreatureRecipe& recipe = test::shipped_recipe();
  size_t lefts = 0, rights = 0;
  for (const baker::JointRecipe& joint : recipe.joints) {
    lefts += (joint.name + "_").find("_l_") != std::string::npos;
    rights += (joint.name + "_").find("_r_") != std::string::npos;
    if (joint.name == "ear_r_2") CHECK(joint.at.x() < 0);
  }
  CHECK(lefts >= 10);
  CHECK(lefts == rights);
}
