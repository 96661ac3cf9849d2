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

const std::string& node_name(const Character& character, int node) {
  return character.nodes[static_cast<size_t>(node)].name;
}

const std::string& joint_name(const Character& character, int joint) {
  return node_name(character, character.joint_node[static_cast<size_t>(joint)]);
}

}  // namespace

TEST_CASE("damaged_spring_bones_are_left_out_and_the_character_is_read") {
  const auto broken = nlohmann::json::parse(R"({"secondaryAnimation": {"boneGroups": [
    7, {"bones": 3}, {"bones": [99, -1, "x", 1.5e300, 2]}, {"stiffiness": "soft", "dragForce": "x", "bones": [1]}]}})",
                                            nullptr, false);
  if (broken.is_discarded()) FAIL("the test's own JSON");
  const Character character = with("VRM", broken, "springs_broken");
  REQUIRE(character.springs.size() == 1);  // the last group's; its numbers are the standard's defaults
  CHECK(character.springs[0].numbers.stiffness == 1);
  CHECK(noted(character, "moves no bone that anything shown hangs on: left out"));
  CHECK(with("VRM", 3, "springs_number").springs.empty());
  CHECK(with("VRM", {{"secondaryAnimation", nullptr}}, "springs_null").springs.empty());
  CHECK(with("VRMC_springBone", {{"springs", {1, {{"joints", {}}}}}}, "springs_one_broken").springs.empty());
}

TEST_CASE("springs_of_version_0_are_roots_with_all_below") {
  const Character character = with("VRM", nlohmann::json::parse(R"({"secondaryAnimation": {"boneGroups": [
    {"comment": "hair", "stiffiness": 2.5, "gravityPower": 0.5, "gravityDir": {"x": 1, "y": 0, "z": 0}, "dragForce": 0.25,
     "hitRadius": 0.03, "colliderGroups": [0], "bones": [1, 0]}]}})"),
                                   "springs_0");
  REQUIRE(character.springs.size() == 1);  // `upper` hangs on `lower`, which is listed after it
  const SpringBones& spring = character.springs[0];
  CHECK(spring.name == "hair");
  CHECK(joint_name(character, spring.root) == "lower");
  CHECK(spring.end == -1);
  CHECK(spring.tail_m == 0.07);  // UniVRM's
  CHECK(spring.numbers.stiffness == 2.5);
  CHECK(spring.numbers.gravity_power == 0.5);
  CHECK(spring.numbers.drag_force == 0.25);
  CHECK(spring.collider_groups == std::vector<int>{0});
  CHECK(spring.numbers.gravity_direction == Vector3::UnitX());
  CHECK(spring.numbers.hit_radius_m == 0.03);
}

TEST_CASE("colliders_are_spheres_in_version_0_and_capsules_too_in_version_1") {
  const Character old = with("VRM", nlohmann::json::parse(R"({"secondaryAnimation": {"colliderGroups": [
    {"node": 1, "colliders": [{"offset": {"x": 0.1, "y": 0.2, "z": 0.3}, "radius": 0.05}, {"radius": "x"}]},
    {"node": 99, "colliders": [{"radius": 1}]}, 7]}})"),
                             "colliders_0");
  REQUIRE(old.colliders.size() == 1);
  CHECK((old.colliders[0].from - Vector3(0.1, 0.2, -0.3)).norm() < 1e-12);  // Unity's z looks the other way
  CHECK(old.colliders[0].from == old.colliders[0].to);
  CHECK(old.colliders[0].radius_m == 0.05);
  CHECK(noted(old, "has no radius: left out"));
  CHECK(noted(old, "is on no joint of the character's skin: left out"));
  const Character now = with("VRMC_springBone", nlohmann::json::parse(R"({"colliders": [
    {"node": 1, "shape": {"capsule": {"offset": [0, 0.1, 0.2], "radius": 0.5, "tail": [0, 0.4, 0.2]}}},
    {"node": 0, "shape": {"sphere": {"offset": [1, 0, 0], "radius": 0.25}}}, {"node": 0, "shape": {"plane": {}}}]})"),
                             "colliders_1");
  REQUIRE(now.colliders.size() == 2);
  CHECK((now.colliders[0].to - Vector3(0, 0.4, 0.2)).norm() < 1e-12);
  CHECK(now.colliders[1].radius_m == 0.25);
}

namespace {

// The bar with joints to spare: nodes 1, 3 and 4 in a row, of which "tip" is in the skin and "tip_end" is
// not.
TinyFile long_bar() {
  TinyFile file = bar();
  file.json["nodes"][1]["children"] = {3};
  file.json["nodes"].push_back({{"name", "tip"}, {"translation", {0, 1, 0}}, {"children", {4}}});
  file.json["nodes"].push_back({{"name", "tip_end"}, {"translation", {0, 1, 0}}});
  const int binds =
      file.add_floats({1, 0, 0, 0, 0, 1,  0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1,  0, 0,
                       0, 0, 1, 0, 0, -1, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1},
                      "MAT4");
  file.json["skins"] = {{{"joints", {0, 1, 3}}, {"inverseBindMatrices", binds}}};
  return file;
}

Character with_springs(const char* springs, const std::string& name) {
  TinyFile file = long_bar();
  file.json["extensions"]["VRMC_springBone"]["springs"] = nlohmann::json::parse(springs);
  return import_gltf(file.write(name));
}

}  // namespace

TEST_CASE("springs_of_version_1_swing_all_joints_but_the_last_which_is_their_end") {
  const Character character = with_springs(R"([{"name": "tail", "joints": [
    {"node": 0, "stiffness": 1.5, "dragForce": 0.25, "gravityPower": 2, "gravityDir": [0, -1, 0]},
    {"node": 1, "stiffness": 1.5, "dragForce": 0.25, "gravityPower": 2}, {"node": 3, "stiffness": 9}]}])",
                                           "springs_1");
  REQUIRE(character.springs.size() == 1);
  const SpringBones& spring = character.springs[0];
  CHECK(spring.name == "tail");
  CHECK(joint_name(character, spring.root) == "lower");
  CHECK(joint_name(character, spring.end) == "upper");
  CHECK(node_name(character, spring.end_node) == "tip");
  CHECK(spring.numbers.stiffness == 1.5);
  CHECK(spring.numbers.drag_force == 0.25);
  CHECK(spring.numbers.gravity_power == 2);
  CHECK(spring.collider_groups.empty());
  CHECK(!noted(character, "differ"));  // the last one's are no bone's
  CHECK(!noted(character, "gravityDir"));
}

TEST_CASE("a_spring_of_one_joint_of_version_1_is_left_out") {
  const Character character =
      with_springs(R"([{"name": "stub", "joints": [{"node": 0}]}])", "springs_1_stub");
  CHECK(character.springs.empty());
  CHECK(noted(character, "spring 'stub' has one joint, which nothing swings: left out"));
}

TEST_CASE("a_spring_of_version_1_of_two_joints_is_one_bone") {
  const Character character = with_springs(R"([{"joints": [{"node": 1}, {"node": 3}]}])", "springs_1_pair");
  REQUIRE(character.springs.size() == 1);
  CHECK(character.springs[0].end == character.springs[0].root);  // not -1, all that is below
  CHECK(node_name(character, character.springs[0].end_node) == "tip");
}

TEST_CASE("a_joint_that_says_nothing_has_the_numbers_of_its_version") {
  const SpringBones zero =
      with("VRM", nlohmann::json::parse(R"({"secondaryAnimation": {"boneGroups": [{"bones": [0]}]}})"),
           "springs_0_bare")
          .springs.at(0);
  CHECK((zero.numbers.stiffness == 1 && zero.numbers.gravity_power == 0 && zero.numbers.drag_force == 0.4));
  const SpringBones one =
      with_springs(R"([{"joints": [{"node": 0}, {"node": 1}]}])", "springs_1_bare").springs.at(0);
  CHECK((one.numbers.stiffness == 1 && one.numbers.gravity_power == 0 && one.numbers.drag_force == 0.5));
}

TEST_CASE("joints_outside_the_skin_end_a_spring_of_version_1") {
  const Character ends =
      with_springs(R"([{"joints": [{"node": 0}, {"node": 1}, {"node": 3}, {"node": 4}]}])", "springs_1_end");
  REQUIRE(ends.springs.size() == 1);
  CHECK(joint_name(ends, ends.springs[0].end) == "tip");
  CHECK(node_name(ends, ends.springs[0].end_node) == "tip_end");
  CHECK(!noted(ends, "nothing that is shown"));
  TinyFile file = long_bar();
  file.json["nodes"][4]["children"] = {5};
  file.json["nodes"].push_back({{"name", "far_end"}, {"translation", {0, 1, 0}}});
  file.json["extensions"]["VRMC_springBone"]["springs"] = nlohmann::json::parse(
      R"([{"name": "hair", "joints": [{"node": 1}, {"node": 3}, {"node": 4}, {"node": 5}]}])");
  const Character outside = import_gltf(file.write("springs_1_outside"));
  REQUIRE(outside.springs.size() == 1);
  CHECK(joint_name(outside, outside.springs[0].end) == "tip");
  CHECK(node_name(outside, outside.springs[0].end_node) == "tip_end");
  CHECK(noted(outside, "spring 'hair' moves nothing that is shown with its last joints"));
}

TEST_CASE("each_joint_of_version_1_keeps_its_numbers_and_gravity_pulls_any_way") {
  const Character character = with_springs(R"([{"name": "tail", "center": 0, "joints": [
    {"node": 0, "gravityPower": 1, "gravityDir": [0, 3, 0]}, {"node": 1, "stiffness": 2, "hitRadius": 0.5}, {"node": 3}]}])",
                                           "springs_1_differ");
  const SpringBones& spring = character.springs.at(0);
  CHECK(spring.numbers.gravity_direction == Vector3::UnitY());
  REQUIRE(spring.of_joints.size() == 2);
  CHECK(spring.of_joints[0].second == spring.numbers);
  CHECK(spring.of_joints[1].first == spring.end);
  CHECK(spring.of_joints[1].second.stiffness == 2);
  CHECK(spring.of_joints[1].second.hit_radius_m == 0.5);
  CHECK(
      noted(character, "spring 'tail' has joints that differ in gravity: the first one's is taken for all"));
  CHECK(noted(character, "spring 'tail' states a center, which is not followed"));
}

TEST_CASE("a_chain_of_version_1_that_is_listed_in_pieces_or_from_its_tip_is_one") {
  for (const char* springs :
       {R"([{"joints": [{"node": 1, "stiffness": 2}, {"node": 3}]}, {"joints": [{"node": 0}, {"node": 1}]}])",
        R"([{"joints": [{"node": 1, "stiffness": 2}, {"node": 3}]},
            {"joints": [{"node": 0}, {"node": 1, "stiffness": 2}, {"node": 3}]}])",
        R"([{"joints": [{"node": 3}, {"node": 1, "stiffness": 2}, {"node": 0}]}])"}) {
    INFO(springs);
    const Character character = with_springs(springs, "springs_1_pieces");
    REQUIRE(character.springs.size() == 1);
    const SpringBones& spring = character.springs[0];
    CHECK(joint_name(character, spring.root) == "lower");
    CHECK(joint_name(character, spring.end) == "upper");
    CHECK(node_name(character, spring.end_node) == "tip");
    REQUIRE(spring.of_joints.size() == 2);
    CHECK(spring.of_joints[1].second.stiffness == 2);
  }
}
