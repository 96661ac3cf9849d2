// tangents.cpp  Tangents that a file states are kept, others lie along the texture's u.
#include "baker/import/meshes/tangents.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

constexpr double kRounding = 1e-6;  // of floats around one
const float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<float> repeated(const std::vector<float>& element, size_t times) {
  std::vector<float> all;
  for (size_t i = 0; i < times; ++i) all.insert(all.end(), element.begin(), element.end());
  return all;
}

// The bar, two units high and one wide, faces along Z; `uv` says where in the texture its places are.
TinyFile textured_bar(const std::function<Vector2(const Vector2&)>& uv) {
  TinyFile file = bar();
  std::vector<float> at;
  for (const double y : {0.0, 1.0, 2.0})
    for (const double x : {0.0, 1.0}) {
      const Vector2 here = uv({x, y});
      at.insert(at.end(), {static_cast<float>(here.x()), static_cast<float>(here.y())});
    }
  file.attribute("NORMAL") = file.add_floats(repeated({0, 0, 1}, 6), "VEC3");
  file.attribute("TEXCOORD_0") = file.add_floats(at, "VEC2");
  return file;
}

// v runs down the picture.
Vector2 upright(const Vector2& place) { return {place.x(), 1 - place.y() / 2}; }

Character import_file(const TinyFile& file, const std::string& name) { return import_gltf(file.write(name)); }

void check_all(const Character& character, const Vector3& along, double sign) {
  REQUIRE(character.tangents.size() == character.positions.size());
  for (const Tangent& tangent : character.tangents) {
    CHECK((tangent.along - along).norm() < kRounding);
    CHECK(tangent.sign == sign);
  }
}

void check_units_square_to_normals(const Character& character) {
  REQUIRE(character.tangents.size() == character.positions.size());
  for (size_t v = 0; v < character.tangents.size(); ++v) {
    CHECK(character.tangents[v].along.norm() == Approx(1));
    CHECK(std::abs(character.tangents[v].along.dot(character.normals[v])) < kRounding);
    CHECK(std::abs(character.tangents[v].sign) == 1);
  }
}

}  // namespace

TEST_CASE("texture_places_that_tell_no_direction_give_any_that_is_square_to_the_normal") {
  const std::vector<std::function<Vector2(const Vector2&)>> useless = {
      [](const Vector2&) { return Vector2(0.5, 0.5); },           // a point of the picture
      [](const Vector2& at) { return Vector2(at.x(), at.x()); },  // a line of it
      [](const Vector2& at) { return Vector2(at.x() < 1 ? 0.5 : HUGE_VAL, at.y()); },
      [](const Vector2& at) { return Vector2(at.x() < 1 ? 0.5 : double{kNan}, at.y()); },
  };
  for (const auto& uv : useless) {
    const Character character = import_file(textured_bar(uv), "useless_uv");
    check_units_square_to_normals(character);
    for (const Tangent& tangent : character.tangents) CHECK(tangent.sign == 1);
  }
}

TEST_CASE("a_character_of_no_tangents_and_no_texture_places_has_none") {
  CHECK(import_file(bar(), "no_tangents").tangents.empty());
  TinyFile file = bar();
  file.attribute("TANGENT") = file.add_floats(repeated({1, 0, 0, 1}, 6), "VEC4");
  CHECK(import_file(file, "no_normals").tangents.empty());  // glTF has them ignored without normals
}

TEST_CASE("tangents_of_an_upright_picture_lie_along_u_and_their_bitangents_point_up_in_it") {
  check_all(import_file(textured_bar(upright), "upright"), Vector3::UnitX(), 1);
  check_all(import_file(textured_bar([](const Vector2& at) { return Vector2(1 - at.y() / 2, 1 - at.x()); }),
                        "turned"),
            -Vector3::UnitY(), 1);  // a quarter turned
}

TEST_CASE("computed_tangents_are_square_to_the_normals_that_the_file_states") {
  TinyFile file = textured_bar(upright);
  file.attribute("NORMAL") = file.add_floats(repeated({0.6f, 0, 0.8f}, 6), "VEC3");
  check_all(import_file(file, "tilted_normals"), Vector3(0.8, 0, -0.6), 1);
}

// The picture is sheared on the lowest triangle alone, where u grows along (1, 1). At vertex 2 that triangle
// has an angle of 45 degrees, and the two others, where u grows along X, of 45 and 90.
TEST_CASE("a_vertex_s_triangles_count_by_their_angles") {
  const auto sheared = [](const Vector2& at) {
    return upright({at.x(), at.x() > 0 && at.y() < 1 ? -1 : at.y()});
  };
  const Character character = import_file(textured_bar(sheared), "sheared");
  const Vector3 wanted = Vector3(1, 1, 0).normalized() + 3 * Vector3::UnitX();
  REQUIRE(character.tangents.size() == 6);
  CHECK((character.tangents[0].along - Vector3(1, 1, 0).normalized()).norm() < kRounding);
  CHECK((character.tangents[2].along - wanted.normalized()).norm() < kRounding);
}

TEST_CASE("tangents_of_a_mirrored_picture_have_the_other_sign") {
  check_all(import_file(textured_bar([](const Vector2& at) {
                          return upright({1 - at.x(), at.y()});
                        }),
                        "mirrored"),
            -Vector3::UnitX(), -1);
}

// The lower half shows the picture upright, the upper half mirrored: the rung between them is on both.
TEST_CASE("a_vertex_where_a_picture_turns_over_takes_the_side_of_the_larger_angle") {
  const Character character = import_file(
      textured_bar([](const Vector2& at) { return Vector2(at.x(), std::abs(at.y() - 1)); }), "turns_over");
  check_units_square_to_normals(character);
  CHECK(character.tangents[0].sign == 1);
  CHECK(character.tangents[5].sign == -1);
  for (const Tangent& tangent : character.tangents)
    CHECK((tangent.along - Vector3::UnitX()).norm() < kRounding);
}

TEST_CASE("tangents_of_a_file_are_kept_and_made_unit_vectors") {
  TinyFile file = textured_bar(upright);
  file.attribute("TANGENT") = file.add_floats(repeated({0, 2, 0, -1}, 6), "VEC4");
  check_all(import_file(file, "stated"), Vector3::UnitY(), -1);
  file.attribute("TANGENT") = file.add<int8_t>(
      {0, 127, 0, -127, 0, 127, 0, -127, 0, 127, 0, -127, 0, 127, 0, -127, 0, 127, 0, -127, 0, 127, 0, -127},
      "VEC4", 5120, true);
  check_all(import_file(file, "stated_bytes"), Vector3::UnitY(), -1);
}

TEST_CASE("tangents_of_a_file_that_are_no_directions_are_computed") {
  TinyFile file = textured_bar(upright);
  std::vector<float> stated = repeated({0, 1, 0, -1}, 6);
  stated[4 * 1] = kNan;
  stated[4 * 2 + 1] = 0;
  file.attribute("TANGENT") = file.add_floats(stated, "VEC4");
  const Character character = import_file(file, "stated_badly");
  for (const size_t v : {1, 2}) CHECK((character.tangents[v].along - Vector3::UnitX()).norm() < kRounding);
  CHECK(character.tangents[1].sign == 1);
  CHECK(character.tangents[3].along == Vector3::UnitY());
}

TEST_CASE("tangents_turn_with_their_mesh_and_change_sides_where_it_is_mirrored") {
  TinyFile file = textured_bar(upright);
  file.attribute("TANGENT") = file.add_floats(repeated({1, 0, 0, 1}, 6), "VEC4");
  // A hat beside the body, turned by a quarter about Y and mirrored along its own X.
  file.json["meshes"].push_back(file.json["meshes"][0]);
  file.json["nodes"].push_back({{"name", "hat"},
                                {"mesh", 1},
                                {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
                                {"scale", {-1, 1, 1}}});
  file.json["nodes"][1]["children"] = {3};
  for (const bool stated : {true, false}) {
    if (!stated) {
      file.attribute("TANGENT") = nullptr;
      for (auto& mesh : file.json["meshes"]) mesh["primitives"][0]["attributes"].erase("TANGENT");
    }
    const Character character = import_file(file, stated ? "hat_stated" : "hat_computed");
    REQUIRE(character.positions.size() == 12);
    CHECK((character.normals[6] - Vector3::UnitX()).norm() < kRounding);
    CHECK((character.tangents[6].along - Vector3::UnitZ()).norm() < kRounding);
    CHECK(character.tangents[6].sign == -1);
    CHECK(character.tangents[0].sign == 1);
  }
}

TEST_CASE("tangents_turn_with_the_axes_and_not_with_the_unit") {
  TinyFile file = textured_bar(upright);
  file.attribute("TANGENT") = file.add_floats(repeated({0, 1, 0, 1}, 6), "VEC4");
  check_all(import_gltf(file.write("tangents_z_up"), {.unit_m = 0.5, .up = 'z'}), -Vector3::UnitZ(), 1);
}

TEST_CASE("default_morph_weights_move_tangents") {
  TinyFile file = textured_bar(upright);
  file.attribute("TANGENT") = file.add_floats(repeated({1, 0, 0, -1}, 6), "VEC4");
  file.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"TANGENT", file.add_floats(repeated({-1, 1, 0}, 6), "VEC3")}}};
  file.json["meshes"][0]["weights"] = {1};
  check_all(import_file(file, "tangents_morphed"), Vector3::UnitY(), -1);
}

TEST_CASE("a_primitive_of_neither_beside_one_with_texture_places_has_any_square_to_its_normals") {
  TinyFile file = textured_bar([](const Vector2& at) { return upright({1 - at.x(), at.y()}); });
  auto& primitives = file.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["attributes"].erase("TEXCOORD_0");
  const Character character = import_file(file, "one_of_two");
  REQUIRE(character.tangents.size() == 12);
  check_units_square_to_normals(character);
  CHECK(character.tangents[0].sign == -1);
  CHECK(character.tangents[6].sign == 1);
}

// Each triangle has vertices of its own: what lies at one place and one uv has one tangent all the same.
TEST_CASE("tangents_of_triangles_that_share_no_vertices_are_as_smooth_as_of_those_that_do") {
  const auto bent = [](const Vector2& at) { return upright({at.x(), at.y() + 0.4 * at.x() * at.y()}); };
  const Character joined = import_file(textured_bar(bent), "joined");
  TinyFile file = textured_bar(bent);
  const std::vector<size_t> corners = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5};
  auto& primitive = file.json["meshes"][0]["primitives"][0];
  std::vector<float> places, normals, uv, weights;
  std::vector<uint8_t> joints;
  for (const size_t c : corners) {
    const Vector2 place(static_cast<double>(c % 2), static_cast<double>(c / 2)), at = bent(place);
    places.insert(places.end(), {static_cast<float>(place.x()), static_cast<float>(place.y()), 0});
    normals.insert(normals.end(), {0, 0, 1});
    uv.insert(uv.end(), {static_cast<float>(at.x()), static_cast<float>(at.y())});
    joints.insert(joints.end(), {0, 0, 0, 0});
    weights.insert(weights.end(), {1, 0, 0, 0});
  }
  file.attribute("POSITION") = file.add_floats(places, "VEC3");
  file.attribute("NORMAL") = file.add_floats(normals, "VEC3");
  file.attribute("TEXCOORD_0") = file.add_floats(uv, "VEC2");
  file.attribute("JOINTS_0") = file.add(joints, "VEC4", 5121);
  file.attribute("WEIGHTS_0") = file.add_floats(weights, "VEC4");
  primitive.erase("indices");
  const Character apart = import_file(file, "apart");
  REQUIRE(apart.tangents.size() == corners.size());
  for (size_t c = 0; c < corners.size(); ++c)
    CHECK((apart.tangents[c].along - joined.tangents[corners[c]].along).norm() < kRounding);
  CHECK((joined.tangents[2].along - Vector3::UnitX()).norm() > 0.01);  // the picture is bent
}

TEST_CASE("tangents_of_characters_are_unit_vectors") {
  const std::filesystem::path folder = SINEW_SHARED_DIR "/characters";
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no characters in " << folder << "; set SINEW_SHARED_DIR");
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    for (const char* name : {"file.glb", "file.gltf", "file.vrm"}) {
      if (!std::filesystem::exists(entry.path() / name)) continue;
      const Character character = import_gltf((entry.path() / name).string());
      INFO(entry.path());
      size_t odd = 0;
      for (const Tangent& tangent : character.tangents)
        odd += std::abs(tangent.along.norm() - 1) < kRounding && std::abs(tangent.sign) == 1 ? 0u : 1u;
      CHECK(odd == 0);
      CHECK((character.tangents.empty() || character.tangents.size() == character.positions.size()));
    }
}
