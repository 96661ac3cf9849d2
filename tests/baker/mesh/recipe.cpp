// recipe.cpp  A tissue recipe is read as it is written, and every slip in it is named.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/recipe/recipe.hpp"

using namespace sinew::baker;

namespace {

std::string write(const std::string& text) {
  const auto path =
      std::filesystem::temp_directory_path() / ("sinew_recipe_" + std::to_string(getpid()) + ".json");
  std::ofstream(path) << text;
  return path.string();
}

std::string refusal(const std::string& text) {
  const std::string path = write(text);
  try {
    read_recipe(path);
  } catch (const BadInput& error) {
    const std::string line = error.what();
    CHECK(line.find('\n') == std::string::npos);
    CHECK(line.find(path) == 0);
    return line;
  }
  return "read";
}

}  // namespace

TEST_CASE("wrong_recipes_are_refused_by_key") {
  const std::vector<std::pair<const char*, const char*>> faults = {
      {"hello", "not JSON"},
      {"[1, 2]", "object"},
      {R"({"young_soft": 1})", "young_soft_pa"},
      {R"({"neighbors": 6})", "neighbours"},
      {R"({"young_soft_pa": 0})", "young_soft_pa"},
      {R"({"young_soft_pa": "soft"})", "young_soft_pa"},
      {R"({"young_soft_pa": 2000, "young_stiff_pa": 1000})", "smaller than young_soft_pa"},
      {R"({"poisson_ratio": 0.5})", "poisson_ratio"},
      {R"({"density_kg_m3": -3})", "density_kg_m3"},
      {R"({"damping_ratio": 1.5})", "damping_ratio"},
      {R"({"voxels_high": 7})", "voxels_high"},
      {R"({"voxels_high": 36.5})", "whole number"},
      {R"({"rigid_stiffness": 2})", "rigid_stiffness"},
      {R"({"core_share": -0.1})", "core_share"},
      {R"({"coreless_joints": "ear_*"})", "coreless_joints"},
      {R"({"nodes_per_region": 4097})", "nodes_per_region"},
      {R"({"neighbours": 1})", "neighbours"},
      {R"({"levels": 40})", "\"levels\" must be a list"},
      {R"({"levels": []})", "\"levels\" must list 1 .. 4"},
      {R"({"levels": [80, 40, 20, 10, 5]})", "\"levels\" must list 1 .. 4"},
      {R"({"levels": [40, 40]})", "\"levels\" must descend"},
      {R"({"levels": [20, 40]})", "\"levels\" must descend"},
      {R"({"levels": [40, 3]})", "\"levels\" holds 3"},
      {R"({"levels": [40, 20.5]})", "\"levels\" must be a list of whole numbers"},
      {R"({"levels": [40, "20"]})", "\"levels\""},
      {R"({"levels": [40], "nodes_per_region": 40})", "\"levels\" states nodes_per_region too"},
      {R"({"left_out": ["cheek"]})", "\"left_out\" needs levels"},
      {R"({"levels": [40], "left_out": "cheek"})", "\"left_out\" must be a list of texts"},
      {R"({"levels": [40, 20, 10, 5], "left_out": ["cheek"]})",
       "\"left_out\" asks for one control graph more"},
      {R"({"layer_m": -0.1})", "\"layer_m\" is -0.1"},
      {R"({"layer_m": 11})", "\"layer_m\" is 11"},
      {R"({"layer_m": "near"})", "layer_m"},
      {R"({"layers_m": 0.01})", "layer_m"},
      {R"({"unit_m": -1})", "unit_m"},
      {R"({"up": "x"})", "\"up\""},
      {R"({"regions": [{"name": "belly"}]})", "joints"},
      {R"({"regions": [{"joints": ["spine"]}]})", "name"},
      {R"({"regions": [{"name": "belly"}]})", "or name a piece by mesh, material or island_at"},
      {R"({"regions": [{"name": "cape", "mesh": ""}]})", "\"mesh\""},
      {R"({"regions": [{"name": "cape", "mesh": ["Cape"]}]})", "\"mesh\""},
      {R"({"regions": [{"name": "cape", "material": 3}]})", "\"material\""},
      {R"({"regions": [{"name": "cape", "island_at": [0, 1]}]})", "\"island_at\""},
      {R"({"regions": [{"name": "cape", "island_at": [0, 1, 1e9]}]})", "\"island_at\""},
      {R"({"regions": [{"name": "cape", "kind": "felt", "mesh": "Cape"}]})",
       "\"kind\" is none of other, belly"},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "stiffness": 2}]})", "stiffness"},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "softness": 1}]})", "softness"},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "touches_body": "yes"}]})",
       "\"touches_body\" must be true or false"},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "touch_body": true}]})", "touches_body"},
      {R"({"touches_body": true})", "touches_body"},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "enabled": 0}]})",
       "\"enabled\" must be true or false"},
      {R"({"regions": [{"name": "belly", "joints": [], "enabled": false}]})", "joints"},
      {R"({"rods": [{"root": "tail", "enabled": false, "density_kg_m3": 0}]})", "density_kg_m3"},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "side": "under"}]})",
       "\"side\" is none of front, back, above, below, inside, outside"},
      {R"({"regions": [{"name": "cape", "mesh": "Cape", "side": "back"}]})",
       "of soft tissue over bones, not of a piece"},
      {R"({"regions": [{"name": "cape", "island_at": [0, 1, 0], "around": true}]})", "not of a piece"},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "around": 1}]})", "\"around\""},
      {R"({"regions": [{"name": "belly", "joints": ["spine"], "side": "front", "around": true}]})",
       "\"around\" means all sides"},
      {R"({"note": 3})", "\"note\""},
      {R"({"rods": {"root": "tail"}})", "list"},
      {R"({"rods": [{"name": "tail"}]})", "root"},
      {R"({"rods": [{"root": "strap", "end_joint": ""}]})", "\"end_joint\" must be a text"},
      {R"({"rods": [{"root": "strap", "end_joint": "buckle", "max_displacement": 0.5}]})",
       "limits the travel of a free end, and end_joint holds it"},
      {R"({"rods": [{"root": "tail", "radius": 0.1}]})", "radius_m"},
      {R"({"rods": [{"root": "tail", "radius_m": 0}]})", "radius_m"},
      {R"({"rods": [{"root": "tail", "density_kg_m3": 0}]})", "density_kg_m3"},
      {R"({"rods": [{"root": "tail", "young_modulus_pa": 0}]})", "rods[0]: \"young_modulus_pa\" is 0"},
      {R"({"rods": [{"root": "ear"}, {"root": "tail", "torsion_modulus_pa": -1}]})",
       "rods[1]: \"torsion_modulus_pa\""},
      {R"({"rods": [{"root": "tail", "frequency_hz": 0}]})", "frequency_hz"},
      {R"({"rods": [{"root": "tail", "frequency_hz": 2, "young_modulus_pa": 1e6}]})",
       "says the same as frequency_hz"},
      {R"({"rods": [{"root": "tail", "damping_s": -1}]})", "damping_s"},
      {R"({"rods": [{"root": "tail", "damping_ratio": 3}]})", "damping_ratio"},
      {R"({"rods": [{"root": "tail", "damping_ratio": 0.2, "damping_s": 0.1}]})",
       "says the same as damping_ratio"},
      {R"({"rods": [{"root": "tail", "drag_per_s": -1}]})", "drag_per_s"},
      {R"({"rods": [{"root": "tail", "gravity": -1}]})", "gravity"},
      {R"({"rods": [{"root": "tail", "start": "zero"}]})", "must be \"continued\" or \"learned\""},
      {R"({"rods": [{"root": "tail", "start": true}]})", "\"start\" must be a text"},
      {R"({"rods": [{"root": "tail", "as_in_file": 1}]})", "as_in_file"},
      {R"({"rods": [{"root": "tail", "as_in_file": true, "frequency_hz": 2}]})",
       "\"frequency_hz\" says otherwise than as_in_file"},
      {R"({"rods": [{"root": "tail", "sag": 2}]})", "sag"},
  };
  for (const auto& [text, says] : faults) {
    const std::string line = refusal(text);
    INFO(text << ": " << line);
    CHECK(line != "read");
    CHECK(line.find(says) != std::string::npos);
  }
  CHECK_THROWS_AS(read_recipe("/nowhere/recipe.json"), BadInput);
}

TEST_CASE("every_key_of_a_recipe_is_read_and_absent_ones_keep_their_default") {
  const Recipe plain = read_recipe(write("{}"));
  CHECK(plain.voxels_high == Recipe().voxels_high);
  CHECK(plain.regions.empty());
  CHECK(!plain.rods.has_value());
  const Recipe recipe = read_recipe(write(R"({
    "young_soft_pa": 1000, "young_stiff_pa": 2000, "poisson_ratio": 0.3, "density_kg_m3": 900, "damping_ratio": 0.2,
    "voxels_high": 20, "rigid_stiffness": 0.5, "core_share": 0.25, "coreless_joints": ["ear_*"], "nodes_per_region": 12,
    "neighbours": 4, "layer_m": 0.02, "unit_m": 0.01, "up": "z", "regions": [{"name": "belly", "joints": ["spine_*", "pelvis"], "stiffness": 0.3},
                {"name": "cheek", "joints": ["head"], "touches_body": true}]})"));
  CHECK(recipe.young_soft_pa == 1000);
  CHECK(recipe.layer_m == 0.02);
  CHECK(recipe.young_stiff_pa == 2000);
  CHECK(recipe.poisson_ratio == 0.3);
  CHECK(recipe.density_kg_m3 == 900);
  CHECK(recipe.damping_ratio == 0.2);
  CHECK(recipe.voxels_high == 20);
  CHECK(recipe.rigid_stiffness == 0.5);
  CHECK(recipe.core_share == 0.25);
  CHECK(recipe.coreless_joints == std::vector<std::string>{"ear_*"});
  CHECK(recipe.nodes_per_region == 12);
  CHECK(recipe.neighbours == 4);
  CHECK(recipe.unit_m == 0.01);
  CHECK(recipe.up == 'z');
  REQUIRE(recipe.regions.size() == 2);
  CHECK(recipe.regions[0].name == "belly");
  CHECK(recipe.regions[0].joints == std::vector<std::string>{"spine_*", "pelvis"});
  CHECK(recipe.regions[0].stiffness == 0.3);
  CHECK_FALSE(recipe.regions[0].touches_body);
  CHECK(recipe.regions[1].touches_body);
}

TEST_CASE("pieces_of_a_region_are_read_with_bones_and_without") {
  const Recipe recipe = read_recipe(write(R"({"regions": [
    {"name": "cape", "mesh": "Mage_Cape"}, {"name": "hair", "material": "Hair*", "joints": ["head"], "kind": "hair"},
    {"name": "tuft", "island_at": [0, 1.5, -0.25]}]})"));
  REQUIRE(recipe.regions.size() == 3);
  CHECK(recipe.regions[0].mesh == "Mage_Cape");
  CHECK(recipe.regions[0].joints.empty());
  CHECK_FALSE(recipe.regions[0].island_at.has_value());
  CHECK(recipe.regions[1].material == "Hair*");
  CHECK(recipe.regions[1].kind == SoftKind::kHair);
  REQUIRE(recipe.regions[2].island_at.has_value());
  CHECK(*recipe.regions[2].island_at == Eigen::Vector3d(0, 1.5, -0.25));
}

TEST_CASE("what_is_not_enabled_is_as_if_it_were_not_there") {
  const Recipe recipe = read_recipe(write(R"({
    "note": "of a test",
    "regions": [{"name": "belly", "joints": ["spine"], "enabled": false, "note": "a doubt"},
                {"name": "cheek", "joints": ["jaw"], "enabled": true, "note": "none"}],
    "rods": [{"root": "tail", "enabled": false, "note": "a doubt"}]})"));
  REQUIRE(recipe.regions.size() == 1);
  CHECK(recipe.regions[0].name == "cheek");
  REQUIRE(recipe.rods.has_value());
  CHECK(recipe.rods->empty());
}

TEST_CASE("one_number_of_nodes_is_one_graph_and_without_any_there_are_three") {
  const Recipe stated = read_recipe(write(R"({"nodes_per_region": 60})"));
  CHECK(stated.nodes_per_region == 60);
  CHECK(stated.coarser_nodes.empty());
  const Recipe usual = read_recipe(write("{}"));
  CHECK(usual.nodes_per_region == 80);
  CHECK(usual.coarser_nodes == std::vector<int>{40, 20});
}

TEST_CASE("levels_take_the_place_of_one_number_of_nodes") {
  const Recipe recipe = read_recipe(write(R"({"levels": [40, 20, 10]})"));
  CHECK(recipe.nodes_per_region == 40);
  CHECK(recipe.coarser_nodes == std::vector<int>{20, 10});
  const Recipe one = read_recipe(write(R"({"levels": [12]})"));
  CHECK(one.nodes_per_region == 12);
  CHECK(one.coarser_nodes.empty());
  CHECK(one.left_out.empty());
  const Recipe less = read_recipe(write(R"({"levels": [40, 20, 10], "left_out": ["cheek*"]})"));
  CHECK(less.left_out == std::vector<std::string>{"cheek*"});
}

TEST_CASE("every_key_of_a_rod_is_read_and_absent_ones_keep_their_default") {
  const Recipe recipe = read_recipe(write(R"({"rods": [
    {"root": "tail_1"},
    {"name": "ear", "root": "ear_1", "end": "ear_3", "end_joint": "head", "radius_m": 0.02, "density_kg_m3": 300, "young_modulus_pa": 2e5,
     "torsion_modulus_pa": 3e5, "damping_s": 0.1, "drag_per_s": 2, "gravity": 0.5, "sag": 0.25, "start": "learned"},
    {"root": "mane", "frequency_hz": 2.5, "start": "continued"}]})"));
  REQUIRE(recipe.rods.has_value());
  const std::vector<RodRecipe>& rods = *recipe.rods;
  REQUIRE(rods.size() == 3);
  CHECK(rods[0].name == "tail_1");
  CHECK(rods[0].end.empty());
  CHECK(rods[0].end_joint.empty());
  CHECK(rods[0].radius_m == 0);
  CHECK(rods[0].young_modulus_pa == RodRecipe().young_modulus_pa);
  CHECK(rods[0].torsion_modulus_pa == rods[0].young_modulus_pa);
  CHECK(rods[0].gravity == 1);
  CHECK(rods[1].name == "ear");
  CHECK(rods[1].root == "ear_1");
  CHECK(rods[1].end == "ear_3");
  CHECK(rods[1].end_joint == "head");
  CHECK(rods[1].radius_m == 0.02);
  CHECK(rods[1].density_kg_m3 == 300);
  CHECK(rods[1].young_modulus_pa == 2e5);
  CHECK(rods[1].torsion_modulus_pa == 3e5);
  CHECK(rods[1].damping_s == 0.1);
  CHECK(rods[1].drag_per_s == 2);
  CHECK(rods[1].gravity == 0.5);
  CHECK(rods[1].sag == 0.25);
  CHECK_FALSE(rods[0].learned_start);
  CHECK(rods[1].learned_start);
  CHECK_FALSE(rods[2].learned_start);
  CHECK(rods[2].frequency_hz == 2.5);
  const Recipe none = read_recipe(write(R"({"rods": []})"));
  CHECK((none.rods.has_value() && none.rods->empty()));
}
