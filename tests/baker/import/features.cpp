// features.cpp  What glTF allows, each on a file as small as it gets.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "baker/import/import_gltf.hpp"
#include "reference_skinning.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

constexpr double kRounding = 1e-12;  // a few double operations on numbers around one

Character import_file(const TinyFile& file, const std::string& name) { return import_gltf(file.write(name)); }

// Every 0.1 s from before to after the clip, importer and second implementation.
void check_against_reference(const TinyFile& file, const std::string& name) {
  const std::string path = file.write(name);
  const Character character = import_gltf(path);
  const ReferenceFile reference(path);
  REQUIRE(!character.clips.empty());
  for (double t = -0.1; t < character.clips[0].duration_s + 0.2; t += 0.1) {
    const auto posed = skin_positions(character, joint_matrices(character, &character.clips[0], t));
    const auto expected = reference.positions(0, t);
    REQUIRE(posed.size() == expected.size());
    for (size_t v = 0; v < posed.size(); ++v) CHECK((posed[v] - expected[v]).norm() < kRounding);
  }
}

bool noted(const Character& character, const std::string& text) {
  return std::any_of(character.notes.begin(), character.notes.end(),
                     [&](const auto& note) { return note.find(text) != std::string::npos; });
}

const std::vector<float> kTimes = {0.25f, 0.5f, 1.0f};
const std::vector<float> kTurns = {0, 0, 0, 1, 0, 0, 0.6f, 0.8f, 0, 0.8f, 0, -0.6f};
const std::vector<float> kMoves = {0, 1, 0, 0.5f, 1.5f, 0, -1, 1, 2};

}  // namespace

TEST_CASE("clips_step_or_run_linearly") {
  for (const char* kind : {"STEP", "LINEAR"}) {
    TinyFile file = bar();
    file.animate(1, "rotation", kind, kTimes, kTurns);
    check_against_reference(file, std::string("turn_") + kind);
    TinyFile other = bar();
    other.animate(1, "translation", kind, kTimes, kMoves);
    check_against_reference(other, std::string("move_") + kind);
  }
}

TEST_CASE("cubic_splines_scale_their_tangents_by_the_key_interval") {
  TinyFile file = bar();
  std::vector<float> values;
  for (int i = 0; i < 27; ++i) values.push_back(static_cast<float>(std::sin(i * 1.7)));
  file.animate(0, "translation", "CUBICSPLINE", kTimes, values);
  check_against_reference(file, "cubic_move");
  // By hand: keys 0 and 1 at times 0 and 2, in- and out-tangents 1: halfway 0.5 + 2 (1/8) - 2 (1/8) = 0.5, a
  // quarter of the way 0.15625 + 2 (0.140625 - 0.046875).
  TinyFile plain = bar();
  plain.animate(0, "translation", "CUBICSPLINE", {0, 2},
                {1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
  const Character character = import_file(plain, "cubic_hand");
  CHECK(joint_matrices(character, &character.clips[0], 1.0)[0](0, 3) == Approx(0.5).margin(kRounding));
  CHECK(joint_matrices(character, &character.clips[0], 0.5)[0](0, 3) == Approx(0.34375).margin(kRounding));
}

TEST_CASE("cubic_rotations_are_normalised") {
  TinyFile file = bar();
  file.animate(1, "rotation", "CUBICSPLINE", {0, 1},
               {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, -1, 0, 0, 0, 1, 0, 0, 0, 0, 0});
  check_against_reference(file, "cubic_turn");
}

TEST_CASE("matrix_nodes_and_nodes_before_their_parents_are_placed_right") {
  TinyFile file = bar();
  file.json["nodes"] = {{{"name", "upper"}, {"translation", {0, 1, 0}}},
                        {{"name", "body"},
                         {"mesh", 0},
                         {"skin", 0},
                         {"translation", {50, 60, 70}}},  // ignored: the mesh is skinned
                        {{"name", "lower"}, {"children", {0}}},
                        {{"name", "root"},
                         {"children", {2, 1}},
                         {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 3, 4, 5, 1}}}};
  file.json["scenes"][0]["nodes"] = {3};
  file.json["skins"][0]["joints"] = {2, 0};
  file.animate(0, "rotation", "LINEAR", kTimes, kTurns);
  check_against_reference(file, "matrix");
  const Character character = import_file(file, "matrix");
  CHECK(character.nodes[0].name == "root");
  CHECK(character.positions[4].isApprox(
      Vector3(3 - 4, 4, 5)));  // the bind pose stands in the scene, as the root puts it
}

TEST_CASE("skin_joints_out_of_order_are_sorted_and_keep_their_vertices") {
  TinyFile file = bar();
  file.json["skins"][0]["joints"] = {
      1, 0};  // now joint 0 of the file is the child; its bind matrix is the root's
  file.animate(1, "rotation", "LINEAR", kTimes, kTurns);
  check_against_reference(file, "order");
  CHECK(import_file(file, "order").joint_parent == std::vector<int>{-1, 0});
}

TEST_CASE("sparse_accessors_overwrite_what_they_name") {
  TinyFile file = bar();
  const int at = file.add<uint8_t>({1, 5}, "SCALAR", 5121), to = file.add_floats({7, 8, 9, 4, 5, 6}, "VEC3");
  file.json["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", at}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", to}}}};
  const Character character = import_file(file, "sparse");
  CHECK(character.positions[1] == Vector3(7, 8, 9));
  CHECK(character.positions[5] == Vector3(4, 5, 6));
  CHECK(character.positions[4] == Vector3(0, 2, 0));
}

TEST_CASE("normalised_integers_and_strides_decode") {
  TinyFile file = bar();
  file.attribute("WEIGHTS_0") = file.add<uint8_t>(
      {255, 0, 0, 0, 255, 0, 0, 0, 51, 204, 0, 0, 102, 153, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0}, "VEC4", 5121,
      true);
  file.attribute("COLOR_0") = file.add<uint16_t>(std::vector<uint16_t>(24, 65535), "VEC4", 5123, true);
  // Normals of three bytes in rows of four.
  std::vector<int8_t> rows(24, 0);
  for (size_t v = 0; v < 6; ++v) rows[4 * v + 2] = -127, rows[4 * v + 3] = 99;
  file.attribute("NORMAL") = file.add(rows, "VEC4", 5120, true);
  file.json["accessors"].back()["type"] = "VEC3";
  file.json["bufferViews"].back()["byteStride"] = 4;
  file.attribute("_STIFFNESS") = file.add<uint8_t>({51, 51, 51, 51, 51, 51}, "SCALAR", 5121, true);
  const Character character = import_file(file, "normalised");
  CHECK(character.stiffness[0] == Approx(0.2).margin(kRounding));
  CHECK(character.skin[2].joint[0] == 1);
  CHECK(character.skin[2].weight[0] == Approx(0.8).margin(kRounding));
  CHECK(character.normals[3] == Vector3(0, 0, -1));
  CHECK(character.colors[0] == std::array<uint8_t, 4>{255, 255, 255, 255});
}

TEST_CASE("a_second_set_of_joints_is_read_and_eight_are_kept") {
  TinyFile file = bar();
  file.attribute("JOINTS_1") = file.add<uint16_t>(std::vector<uint16_t>(24, 1), "VEC4", 5123);
  file.attribute("WEIGHTS_1") =
      file.add_floats({.5f, .5f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  const Character character = import_file(file, "set1");
  CHECK(character.skin[0].weight[0] ==
        Approx(0.5).margin(kRounding));  // 1 on joint 0, twice a half on joint 1, normalised
  CHECK(character.skin[0].weight[1] == Approx(0.5).margin(kRounding));
  CHECK(character.skin[0].weight[2] == 0);
}

TEST_CASE("strips_fans_and_unindexed_triangles_face_as_a_list_does") {
  const auto triangles = [](int mode, std::vector<uint16_t> indices) {
    TinyFile file = bar();
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    if (indices.empty())
      primitive.erase("indices");
    else
      primitive["indices"] = file.add(indices, "SCALAR", 5123);
    return import_file(file, "mode_" + std::to_string(mode)).triangles;
  };
  using Faces = std::vector<std::array<int, 3>>;
  CHECK(triangles(5, {0, 1, 2, 3, 4, 5}) == Faces{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}});
  CHECK(triangles(5, {}) == Faces{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}});
  CHECK(triangles(6, {0, 1, 3, 5}) == Faces{{1, 3, 0}, {3, 5, 0}});
  CHECK(triangles(4, {}) == Faces{{0, 1, 2}, {3, 4, 5}});
}

TEST_CASE("degenerate_triangles_points_and_morph_targets_are_left_out_with_a_note") {
  TinyFile file = bar();
  auto& primitives = file.json["meshes"][0]["primitives"];
  primitives[0]["indices"] = file.add<uint16_t>({0, 1, 2, 2, 2, 3, 0, 2, 4, 0}, "SCALAR", 5123);
  primitives[0]["targets"] = {{{"POSITION", 0}}};
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  const Character character = import_file(file, "left_out");
  CHECK(character.triangles.size() == 1);
  CHECK(noted(character, "2 triangles without area"));
  CHECK(noted(character, "1 corners after the last whole triangle"));
  CHECK(noted(character, "1 morph targets"));
  CHECK(noted(character, "points or lines"));
}

TEST_CASE("vertices_doubled_by_a_seam_are_welded_only_if_they_move_alike") {
  TinyFile file = bar();
  file.attribute("POSITION") = file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 2, 0},
                                               "VEC3");  // 2, 3 and 4 at one place
  const Character character = import_file(file, "weld");
  CHECK(character.welded == std::vector<int>{0, 1, 2, 2, 4, 5});  // 4 hangs on the upper joint alone
}

TEST_CASE("places_that_differ_by_rounding_are_welded_wherever_they_lie") {
  constexpr float kHeight = 2, kAside = 0.5e-6f * kHeight, kApart = 2e-6f * kHeight;
  for (int step = 0; step < 100; ++step) {  // across whatever cells they are sorted into
    const float x = 0.3f + 0.37e-6f * static_cast<float>(step);
    TinyFile file = bar();
    file.attribute("POSITION") =
        file.add_floats({0, 0, 0, 1, 0, 0, x, 1, 0, x - kAside, 1, 0, x + kApart, 1, 0, 1, 2, 0}, "VEC3");
    file.attribute("WEIGHTS_0") = file.add_floats(
        {1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, .5f, .5f, 0, 0, .5f, .5f, 0, 0, 0, 1, 0, 0}, "VEC4");
    INFO(x);
    CHECK(import_file(file, "rounded").welded == std::vector<int>{0, 1, 2, 2, 4, 5});
  }
}

TEST_CASE("seams_whose_weights_were_smoothed_on_either_side_are_welded") {
  TinyFile file = bar();
  file.attribute("POSITION") =
      file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 2, 0}, "VEC3");  // 2, 3 and 4
  file.attribute("WEIGHTS_0") = file.add_floats(
      {1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, .504f, .496f, 0, 0, .52f, .48f, 0, 0, 0, 1, 0, 0}, "VEC4");
  const Character character = import_file(file, "smoothed");
  CHECK(character.welded == std::vector<int>{0, 1, 2, 2, 4, 5});
  CHECK(character.skin[3].weight[0] == Approx(0.504));  // each is skinned as the file says
}

TEST_CASE("meshes_without_skin_move_rigidly_with_what_is_above_them") {
  TinyFile file = bar();
  file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 3}}}}});
  file.json["nodes"].push_back(
      {{"name", "hat"}, {"mesh", 1}, {"translation", {0, 2, 0}}, {"scale", {2, 2, 2}}});
  file.json["nodes"][1]["children"] = {3};
  file.animate(1, "rotation", "LINEAR", kTimes, kTurns);
  check_against_reference(file, "hat_on_joint");
  CHECK(import_file(file, "hat_on_joint").joint_node.size() == 2);

  TinyFile moving = file;
  moving.json.erase("animations");
  moving.animate(3, "translation", "LINEAR", kTimes, kMoves);
  check_against_reference(moving, "hat_moves");
  CHECK(import_file(moving, "hat_moves").joint_node.size() == 3);
}

TEST_CASE("skins_share_joints_where_their_binds_agree") {
  TinyFile file = bar();
  file.json["nodes"].push_back({{"name", "coat"}, {"mesh", 0}, {"skin", 1}});
  file.json["scenes"][0]["nodes"].push_back(3);
  file.json["skins"].push_back(file.json["skins"][0]);
  CHECK(import_file(file, "same_skin").joint_node.size() == 2);
  // Another bind of the upper joint: a joint of its own on the same node.
  file.json["skins"][1]["inverseBindMatrices"] = file.add_floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1.5f, 0, 1},
      "MAT4");
  file.animate(1, "rotation", "LINEAR", kTimes, kTurns);
  check_against_reference(file, "other_skin");
  CHECK(import_file(file, "other_skin").joint_node.size() == 3);
}

TEST_CASE("z_up_and_centimetres_become_y_up_and_metres") {
  TinyFile file = bar();
  file.attribute("POSITION") =
      file.add_floats({0, 0, 0, 100, 0, 0, 0, 0, 100, 100, 0, 100, 0, 0, 200, 100, 50, 200}, "VEC3");
  const std::string path = file.write("z_up");
  const Character character = import_gltf(path, {.up = 'z'});
  CHECK(character.positions[5].isApprox(Vector3(1, 2, -0.5)));
  const auto posed = skin_positions(character, joint_matrices(character, nullptr, 0));
  for (size_t v = 0; v < posed.size(); ++v) CHECK((posed[v] - character.positions[v]).norm() < kRounding);
  CHECK(noted(character, "taken as centimetres"));
  CHECK(import_gltf(path, {.unit_m = 0.1, .up = 'z'}).positions[5].isApprox(Vector3(10, 20, -5)));
}

TEST_CASE("painted_stiffness_is_clamped_and_meshes_without_it_are_rigid") {
  TinyFile file = bar();
  file.attribute("_STIFFNESS") = file.add_floats({0, 0.25f, 2, -1, NAN, 1}, "SCALAR");
  file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}});
  file.json["nodes"][1]["mesh"] = 1;
  const Character character = import_file(file, "stiffness");
  CHECK(std::vector<double>(character.stiffness.end() - 6, character.stiffness.end()) ==
        std::vector<double>{0, 0.25, 1, 0, 1, 1});
  CHECK(std::vector<double>(character.stiffness.begin(), character.stiffness.begin() + 6) ==
        std::vector<double>(6, 1));
  CHECK(noted(character, "3 values of _STIFFNESS"));
  CHECK(import_file(bar(), "unpainted").stiffness.empty());
}

TEST_CASE("paint_is_taken_in_any_case_of_letters_and_as_a_vector_or_colour") {
  const std::vector<double> half(6, 0.5);
  TinyFile file = bar();
  file.attribute("_stiffness") = file.add_floats(std::vector<float>(18, 0.5f), "VEC3");
  CHECK(import_file(file, "paint_vector").stiffness == half);
  file = bar();
  file.attribute("_Stiffness") = file.add<uint8_t>(std::vector<uint8_t>(24, 51), "VEC4", 5121, true);
  CHECK(import_file(file, "paint_bytes").stiffness == std::vector<double>(6, 0.2));
  file = bar();
  file.attribute("_STIFFNESS") = file.add<uint8_t>({0, 51, 255, 255, 255, 255}, "SCALAR", 5121);
  const Character plain = import_file(file, "paint_plain_bytes");  // whole numbers, and not marked as shares
  CHECK(plain.stiffness == std::vector<double>{0, 0.2, 1, 1, 1, 1});
  CHECK(!noted(plain, "_STIFFNESS"));
  file = bar();
  file.attribute("_STIFFNESS") = file.add_floats(std::vector<float>(16, 0.5f), "MAT4");
  CHECK_THROWS_WITH(import_file(file, "paint_matrix"), Catch::Contains("_STIFFNESS"));
}

TEST_CASE("default_morph_weights_shape_the_bind_pose_the_node_s_before_the_mesh_s") {
  TinyFile file = bar();
  const int up = file.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3"),
            wide = file.add_floats({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
  file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", wide}}};
  file.json["meshes"][0]["weights"] = {1, 0};
  CHECK(import_file(file, "morph_mesh").positions[5] == Vector3(1, 2, 1));
  file.json["nodes"][2]["weights"] = {0.5, 2};
  const Character character = import_file(file, "morph_node");
  CHECK(character.positions[5] == Vector3(3, 2, 0.5));
  CHECK(noted(character, "the shape that they have by default is baked"));
  file.json["meshes"][0]["primitives"][0]["targets"][1]["POSITION"] = file.add_floats({1, 2, 3}, "VEC3");
  CHECK_THROWS_WITH(import_file(file, "morph_short"), Catch::Contains("morph target 1 POSITION"));
  file.json["meshes"][0]["primitives"][0]["targets"] =
      nlohmann::json::array_t(300, nlohmann::json{{"POSITION", up}});
  file.json["nodes"][2]["weights"] = std::vector<double>(300, 1);
  CHECK_THROWS_WITH(import_gltf(file.write("morph_many"), {.max_vertices = 6}),
                    Catch::Contains("morph targets move too many vertices"));
}

TEST_CASE("names_of_meshes_and_materials_are_kept_with_the_vertices_that_have_them") {
  TinyFile file = bar();
  file.json["meshes"][0]["name"] = "Ladder";
  file.json["materials"] = {{{"name", "Wood"}}, nlohmann::json::object(), {{"name", "Rope"}}};
  auto& primitives = file.json["meshes"][0]["primitives"];
  const int low = file.add<uint16_t>({0, 1, 2}, "SCALAR", 5123),
            high = file.add<uint16_t>({2, 3, 5, 2, 5, 4}, "SCALAR", 5123);
  primitives.push_back(primitives[0]);
  primitives.push_back(primitives[0]);
  for (size_t p = 0; p < 3; ++p) primitives[p]["material"] = std::array{2, 0, 1}[p];
  primitives[0]["indices"] = high;
  primitives[1]["indices"] = low;
  const Character character = import_file(file, "materials");
  CHECK(character.meshes.at(0).name == "Ladder");
  REQUIRE(character.materials.size() == 2);  // one has no name
  CHECK(character.materials[0].name == "Wood");
  CHECK(character.materials[0].vertices == std::vector<int>{0, 1, 2});
  CHECK(character.materials[1].name == "Rope");
  CHECK(character.materials[1].vertices == std::vector<int>{2, 3, 4, 5});
  primitives[0]["material"] = 17;  // drawn white, and painted by none
  CHECK(import_file(file, "materials_wrong").materials.size() == 1);
}

TEST_CASE("vertex_colours_multiply_the_material_and_become_srgb") {
  TinyFile file = bar();
  file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 0.5}}}}}};
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.attribute("COLOR_0") = file.add_floats(std::vector<float>(18, 0.5f), "VEC3");
  CHECK(import_file(file, "colour").colors[0] ==
        std::array<uint8_t, 4>{188, 137, 0, 128});  // sRGB of 0.5, 0.25 and 0
}

// A PNG of a red pixel and a blue one beside it.
TEST_CASE("a_base_colour_texture_is_looked_up_at_vertices_and_repeats") {
  TinyFile file = bar();
  file.json["images"] = {
      {{"uri",
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR42mP4zwAE/wEHAAH/"
        "PX2MSQAAAABJRU5ErkJggg=="}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.attribute("TEXCOORD_0") = file.add_floats(
      {0.2f, 0, 0.8f, 0, 1.2f, 5, -0.2f, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0.2f, 0}, "VEC2");
  const std::array<uint8_t, 4> red = {255, 0, 0, 255}, blue = {0, 0, 255, 255}, white = {255, 255, 255, 255};
  const auto colors = import_file(file, "texture").colors;
  CHECK(
      (colors[0] == red && colors[1] == blue && colors[2] == red && colors[3] == blue && colors[4] == white));

  file.json["images"][0]["uri"] = "data:image/png;base64,aGVsbG8=";
  const Character damaged = import_file(file, "texture_damaged");
  CHECK(damaged.colors[0] == white);
  CHECK(noted(damaged, "base colour texture cannot be read"));
  file.json["textures"][0]["source"] = 7;
  CHECK(import_file(file, "texture_missing").colors[0] == white);
}

TEST_CASE("channels_that_cannot_be_played_are_left_out_with_a_note") {
  TinyFile file = bar();
  file.animate(1, "translation", "LINEAR", {0, 1, 0.5f}, kMoves);
  file.animate(1, "translation", "LINEAR", {0, 1}, kMoves);
  file.animate(1, "translation", "LINEAR", kTimes, {0, 0, 0, 0, 0, 0, 0, 0, NAN});
  const Character character = import_file(file, "channels");
  CHECK(character.clips.empty());
  CHECK(noted(character, "do not ascend"));
  CHECK(noted(character, "2 times but 3 values"));
  CHECK(noted(character, "NaN or infinite"));
}
