// spring_bones.cpp  Spring bones of VRM 0 and 1, on a file as small as it gets.
#include <algorithm>
#include <catch2/catch.hpp>

#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

bool noted(const Character& character, const std::string& text) {
  return std::any_of(character.notes.begin(), character.notes.end(),
                     [&](const auto& note) { return note.find(text) != std::string::npos; });
}

Character with(const char* extension, const nlohmann::json& content, const std::string& name) {
  TinyFile file = bar();
  file.json["extensions"][extension] = content;
  return import_gltf(file.write(name));
}

}  // namespace

TEST_CASE("damaged_spring_bones_are_left_out_and_the_character_is_read") {
  const auto broken = nlohmann::json::parse(R"({"secondaryAnimation": {"boneGroups": [
    7, {"bones": 3}, {"bones": [99, -1, "x", 1.5e300, 2]}, {"stiffiness": "soft", "dragForce": "x", "bones": [1]}]}})",
                                            nullptr, false);
  if (broken.is_discarded()) FAIL("the test's own JSON");
  const Character character = with("VRM", broken, "springs_broken");
  REQUIRE(character.springs.size() == 1);  // the last group's; its numbers are the standard's defaults
  CHECK(character.springs[0].stiffness == 1);
  CHECK(noted(character, "is no joint of the character's skin: left out"));
  CHECK(with("VRM", 3, "springs_number").springs.empty());
  CHECK(with("VRM", {{"secondaryAnimation", nullptr}}, "springs_null").springs.empty());
  CHECK(with("VRMC_springBone", {{"springs", {1, {{"joints", {}}}}}}, "springs_one_broken").springs.empty());
}

TEST_CASE("springs_of_version_0_are_roots_with_all_below") {
  const Character character = with("VRM", nlohmann::json::parse(R"({"secondaryAnimation": {"boneGroups": [
    {"comment": "hair", "stiffiness": 2.5, "gravityPower": 0.5, "gravityDir": {"x": 1, "y": 0, "z": 0}, "dragForce": 0.25,
     "hitRadius": 0.03, "colliderGroups": [0], "bones": [1, 0]}]}})"),
                                   "springs_0");
  REQUIRE(character.springs.size() == 2);
  const SpringBones& spring = character.springs[0];
  CHECK(spring.name == "hair");
  CHECK(character.nodes[static_cast<size_t>(character.joint_node[static_cast<size_t>(spring.root)])].name ==
        "upper");
  CHECK(spring.end == -1);
  CHECK(spring.stiffness == 2.5);
  CHECK(spring.gravity_power == 0.5);
  CHECK(spring.drag_force == 0.25);
  CHECK(spring.hit_radius_m == 0.03);
  CHECK(spring.collides);
  CHECK(noted(character, "gravityDir is not straight down"));
}

TEST_CASE("springs_of_version_1_run_from_first_to_last_joint") {
  const Character character = with("VRMC_springBone", nlohmann::json::parse(R"({"springs": [
    {"name": "tail", "joints": [{"node": 0, "stiffness": 1.5, "dragForce": 0.5, "gravityDir": [0, -1, 0]}, {"node": 1}]}]})"),
                                   "springs_1");
  REQUIRE(character.springs.size() == 1);
  const SpringBones& spring = character.springs[0];
  CHECK(spring.name == "tail");
  CHECK(spring.root == 0);
  CHECK(spring.end == 1);
  CHECK(spring.stiffness == 1.5);
  CHECK(spring.drag_force == 0.5);
  CHECK(!spring.collides);
}
