// node_constraints.cpp  Clips are played with the constraints that their nodes have.
#include "baker/import/vrm/node_constraints.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

constexpr double kRounding = 1e-6;  // keys are floats

// `upper` has the constraint, and the clip turns node 3, which hangs on `lower` beside it, in one second.
TinyFile constrained(const nlohmann::json& constraint, const std::vector<float>& turn) {
  TinyFile file = bar();
  file.json["nodes"].push_back({{"name", "hand"}, {"translation", {1, 1, 0}}});
  file.json["nodes"][0]["children"] = {1, 3};
  file.json["nodes"][1]["extensions"]["VRMC_node_constraint"] = {{"specVersion", "1.0"},
                                                                 {"constraint", constraint}};
  std::vector<float> keys = {0, 0, 0, 1};
  keys.insert(keys.end(), turn.begin(), turn.end());
  file.animate(3, "rotation", "LINEAR", {0, 1}, keys);
  return file;
}

Eigen::AngleAxisd turn_of_upper(const TinyFile& file) {
  const Character character = import_gltf(file.write("constrained"));
  const Matrix4 upper = joint_matrices(character, &character.clips.at(0), 1).at(1);
  return Eigen::AngleAxisd(Eigen::Matrix3d(upper.topLeftCorner<3, 3>()));
}

const std::vector<float> kQuarterAboutX = {0.70710678f, 0, 0, 0.70710678f},
                         kQuarterAboutY = {0, 0.70710678f, 0, 0.70710678f};
constexpr double kQuarter = std::numbers::pi / 2;

}  // namespace

TEST_CASE("damaged_constraints_are_noted_with_their_node_and_left_out") {
  for (const nlohmann::json& broken :
       {nlohmann::json(3), nlohmann::json{{"roll", {{"source", 99}, {"rollAxis", "X"}}}},
        nlohmann::json{{"roll", {{"source", 3}, {"rollAxis", "sideways"}}}},
        nlohmann::json{{"rotation", {{"source", 1}}}}}) {
    const TinyFile file = constrained(broken, kQuarterAboutX);
    CHECK(turn_of_upper(file).angle() < kRounding);
    const std::vector<std::string> notes = import_gltf(file.write("constrained")).notes;
    CHECK(std::ranges::any_of(notes, [](const std::string& note) {
      return note.find("'upper'") != std::string::npos &&
             note.find("VRMC_node_constraint") != std::string::npos;
    }));
  }
}

TEST_CASE("a_rotation_constraint_turns_as_far_as_its_weight_says") {
  const Eigen::AngleAxisd whole = turn_of_upper(constrained({{"rotation", {{"source", 3}}}}, kQuarterAboutX));
  CHECK(whole.angle() == Approx(kQuarter).margin(kRounding));
  CHECK(std::abs(whole.axis().x()) == Approx(1).margin(kRounding));
  const Eigen::AngleAxisd half =
      turn_of_upper(constrained({{"rotation", {{"source", 3}, {"weight", 0.5}}}}, kQuarterAboutX));
  CHECK(half.angle() == Approx(kQuarter / 2).margin(kRounding));
}

TEST_CASE("a_roll_constraint_takes_the_turn_about_its_axis_alone") {
  const nlohmann::json roll = {{"roll", {{"source", 3}, {"rollAxis", "X"}, {"weight", 0.5}}}};
  CHECK(turn_of_upper(constrained(roll, kQuarterAboutX)).angle() == Approx(kQuarter / 2).margin(kRounding));
  CHECK(turn_of_upper(constrained(roll, kQuarterAboutY)).angle() < kRounding);
}

TEST_CASE("an_aim_constraint_points_its_axis_at_the_source") {
  TinyFile file = constrained({{"aim", {{"source", 3}, {"aimAxis", "PositiveX"}}}}, kQuarterAboutX);
  CHECK(turn_of_upper(file).angle() < kRounding);                        // it lies along X as it is
  file.animate(3, "translation", "LINEAR", {0, 1}, {1, 1, 0, 0, 2, 0});  // above it
  const Character character = import_gltf(file.write("aim"));
  const Matrix4 upper = joint_matrices(character, &character.clips.at(1), 1).at(1);
  CHECK((upper.topLeftCorner<3, 3>() * Vector3::UnitX() - Vector3::UnitY()).norm() < kRounding);
}

TEST_CASE("a_mesh_without_a_skin_follows_the_constraint_of_its_node") {
  TinyFile file = constrained({{"rotation", {{"source", 3}}}}, kQuarterAboutX);
  file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}});
  file.json["nodes"].push_back(
      {{"name", "eye"},
       {"mesh", 1},
       {"extensions", {{"VRMC_node_constraint", {{"constraint", {{"rotation", {{"source", 3}}}}}}}}}});
  file.json["nodes"][0]["children"] = {1, 3, 4};
  const Character character = import_gltf(file.write("constrained_eye"));
  REQUIRE(character.joint_node.size() == 3);
  const Matrix4 eye = joint_matrices(character, &character.clips.at(0), 1).at(2);
  CHECK(Eigen::AngleAxisd(Eigen::Matrix3d(eye.topLeftCorner<3, 3>())).angle() ==
        Approx(kQuarter).margin(kRounding));
}
