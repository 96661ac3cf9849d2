// bind_pose.cpp  A character as it was bound, whatever frame its file was exported in.
#include "baker/import/skeleton/bind_pose.hpp"

#include <catch2/catch.hpp>

#include "baker/import/import_gltf.hpp"
#include "reference_skinning.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

constexpr double kRounding = 1e-6;  // matrices and rotations of the files are floats

Character import_file(const TinyFile& file, const std::string& name) { return import_gltf(file.write(name)); }

const std::vector<double> kOnItsBack = {-0.7071067811865475, 0, 0, 0.7071067811865476};

double largest_difference(const std::vector<Vector3>& a, const std::vector<Vector3>& b,
                          const Vector3& moved = Vector3::Zero()) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v] - moved).norm());
  return largest;
}

// The bar in a mesh space of half its size, as exporters that quantise write it.
TinyFile halved() {
  TinyFile file = bar();
  file.attribute("POSITION") =
      file.add_floats({0, 0, 0, .5f, 0, 0, 0, .5f, 0, .5f, .5f, 0, 0, 1, 0, .5f, 1, 0}, "VEC3");
  file.json["skins"][0]["inverseBindMatrices"] = file.add_floats(
      {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, -1, 0, 1},
      "MAT4");
  return file;
}

}  // namespace

TEST_CASE("a_root_that_lies_in_the_exported_frame_stands_as_it_was_bound") {
  const std::vector<Vector3> bound = import_file(bar(), "standing").positions;
  TinyFile file = bar();
  file.json["nodes"][0]["rotation"] = kOnItsBack;
  file.json["nodes"][0]["translation"] = {0, 0.25, 0};
  const Character lying = import_file(file, "lying");
  CHECK(largest_difference(lying.positions, bound) < kRounding);
  // What the file shows is what it shows, whatever it was bound as.
  CHECK(largest_difference(skin_positions(lying, joint_matrices(lying, nullptr, 0)),
                           ReferenceFile(file.write("lying")).positions(-1, 0)) < kRounding);
  CHECK(largest_difference(skin_positions(lying, bind_matrices(lying)), lying.positions) < kRounding);
}

TEST_CASE("a_mesh_space_of_the_exporter_s_own_is_taken_in_size_and_place") {
  const std::vector<Vector3> bound = import_file(bar(), "standing").positions;
  CHECK(largest_difference(import_file(halved(), "halved").positions, bound) < kRounding);
  TinyFile lying = halved();
  lying.json["nodes"][0]["rotation"] = kOnItsBack;
  lying.json["nodes"][0]["translation"] = {0, 0.25, 0};
  // Its size is only in the bones: the root stays where it lies, and the rest stands on it.
  CHECK(largest_difference(import_file(lying, "halved_lying").positions, bound, {0, 0.25, 0}) < kRounding);
}

TEST_CASE("a_skeleton_below_a_node_that_turns_it_upright_is_bound_upright") {
  TinyFile file = bar();  // modelled with Z up, and its mesh at the scene's root
  file.attribute("POSITION") =
      file.add_floats({0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1, 0, 0, 2, 1, 0, 2}, "VEC3");
  file.json["nodes"][1]["translation"] = {0, 0, 1};
  file.json["skins"][0]["inverseBindMatrices"] = file.add_floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1},
      "MAT4");
  file.json["nodes"].push_back({{"name", "armature"}, {"children", {0}}, {"rotation", kOnItsBack}});
  file.json["scenes"][0]["nodes"] = {3, 2};
  const std::vector<Vector3> bound = import_file(bar(), "standing").positions;
  CHECK(largest_difference(import_file(file, "z_up_armature").positions, bound) < kRounding);
  file.json["nodes"][1]["rotation"] = {0, 0.6, 0, 0.8};  // a later frame of its clip
  CHECK(largest_difference(import_file(file, "z_up_later").positions, bound) < kRounding);
}

TEST_CASE("a_mesh_that_was_bound_in_the_scene_below_a_turned_node_stays_as_it_rests") {
  TinyFile file = bar();
  const std::vector<Vector3> bound = import_file(file, "standing").positions;
  // The armature and the mesh's node are turned and shrunk, and the root joint turns all of it back.
  file.json["nodes"].push_back(
      {{"name", "armature"}, {"children", {0, 2}}, {"rotation", kOnItsBack}, {"scale", {0.01, 0.01, 0.01}}});
  file.json["nodes"][0]["rotation"] = {0.7071067811865475, 0, 0, 0.7071067811865476};
  file.json["nodes"][0]["scale"] = {100, 100, 100};
  file.json["scenes"][0]["nodes"] = {3};
  CHECK(largest_difference(import_file(file, "scene_space").positions, bound) < kRounding);
}

TEST_CASE("a_mesh_that_is_hidden_by_a_scale_of_zero_is_no_obstacle") {
  TinyFile file = bar();
  file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}});
  file.json["nodes"].push_back({{"name", "sword"}, {"mesh", 1}, {"scale", {0, 0, 0}}});
  file.json["nodes"][1]["children"] = {3};
  for (const MeshSpan& mesh : import_file(file, "hidden_sword").meshes)
    CHECK(mesh.mesh_from_bind.allFinite());
}

TEST_CASE("a_skin_without_binds_has_the_shape_that_viewers_show") {
  TinyFile file = bar();
  file.json["skins"][0].erase("inverseBindMatrices");
  file.json["nodes"][1]["rotation"] = {0, 0, 0.6, 0.8};
  const std::string path = file.write("no_binds");
  const Character character = import_gltf(path);
  CHECK(largest_difference(character.positions, ReferenceFile(path).positions(-1, 0)) < kRounding);
  CHECK(largest_difference(skin_positions(character, bind_matrices(character)), character.positions) <
        kRounding);
  CHECK(character.notes ==
        std::vector<std::string>{"no normals in at least one primitive: computed, smooth below 60 degrees"});
}

TEST_CASE("skins_stand_on_one_skeleton_and_share_joints_up_to_float_rounding") {
  TinyFile file = bar();
  file.json["meshes"].push_back(file.json["meshes"][0]);
  file.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] =
      file.add_floats({0, 0, 0, .1f, 0, 0, 0, .1f, 0, .1f, .1f, 0, 0, .2f, 0, .1f, .2f, 0}, "VEC3");
  file.json["nodes"].push_back({{"name", "coat"}, {"mesh", 1}, {"skin", 1}});
  file.json["scenes"][0]["nodes"].push_back(3);
  file.json["skins"].push_back(file.json["skins"][0]);
  file.json["skins"][1]["inverseBindMatrices"] =
      file.add_floats({10, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 1e-6f,      0, 1,
                       10, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, -1.000002f, 0, 1},
                      "MAT4");
  file.json["nodes"][0]["rotation"] = kOnItsBack;
  const Character character = import_file(file, "two_skins");
  CHECK(character.joint_node.size() == 2);
  for (size_t v = 0; v < 6; ++v) CHECK((character.positions[v] - character.positions[v + 6]).norm() < 1e-5);
}
