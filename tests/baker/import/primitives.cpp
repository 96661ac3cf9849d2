// primitives.cpp  An engine finds each vertex where its own loader put it: primitive by primitive, in the
// order of the file's accessors.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

Character import_file(const TinyFile& file, const std::string& name) { return import_gltf(file.write(name)); }

bool noted(const Character& character, const std::string& text) {
  return std::any_of(character.notes.begin(), character.notes.end(),
                     [&](const auto& note) { return note.find(text) != std::string::npos; });
}

nlohmann::json& primitives_of(TinyFile& file) { return file.json["meshes"][0]["primitives"]; }

// The bar's rungs moved aside: other vertices than its own, and as many.
int moved_places(TinyFile& file, float aside) {
  std::vector<float> places;
  for (const float y : {0.0f, 1.0f, 2.0f})
    for (const float x : {0.0f, 1.0f}) places.insert(places.end(), {x + aside, y, 0});
  return file.add_floats(places, "VEC3");
}

// The bar, and beside it a second primitive of its mesh, painted by "Rope", with a lone point between them.
TinyFile two_bars() {
  TinyFile file = bar();
  file.json["materials"] = {nlohmann::json::object(), {{"name", "Rope"}}};
  nlohmann::json second = primitives_of(file)[0];
  second["attributes"]["POSITION"] = moved_places(file, 3);
  second["material"] = 1;
  primitives_of(file)[0]["material"] = 0;
  primitives_of(file).push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  primitives_of(file).push_back(second);
  return file;
}

// Vertices of those that have their own, and triangles of all, follow one another to the last, and no
// triangle leaves its primitive.
void check_covered(const Character& character) {
  size_t vertices = 0, triangles = 0, mesh = 0;
  for (const PrimitiveSpan& primitive : character.primitives) {
    REQUIRE(primitive.mesh < character.meshes.size());
    CHECK(primitive.mesh >= mesh);
    mesh = primitive.mesh;
    if (primitive.sharer < 0) {
      CHECK(primitive.first_vertex == vertices);
      vertices += primitive.vertex_count;
    }
    CHECK(primitive.first_vertex >= character.meshes[mesh].first_vertex);
    CHECK(primitive.first_vertex + primitive.vertex_count <=
          character.meshes[mesh].first_vertex + character.meshes[mesh].vertex_count);
    CHECK(primitive.first_triangle == triangles);
    triangles += primitive.triangle_count;
    REQUIRE(triangles <= character.triangles.size());
    for (size_t t = primitive.first_triangle; t < triangles; ++t)
      for (const int corner : character.triangles[t])
        CHECK(static_cast<size_t>(corner) - primitive.first_vertex < primitive.vertex_count);
  }
  CHECK(vertices == character.positions.size());
  CHECK(triangles == character.triangles.size());
}

}  // namespace

TEST_CASE("tangents_and_texture_places_that_cannot_be_read_refuse_no_file") {
  for (const char* name : {"TANGENT", "TEXCOORD_0"}) {
    for (const auto& [what, accessor] : {std::pair{"missing", 99}, {"wide", 2}, {"short", -1}}) {
      TinyFile file = bar();
      file.attribute("NORMAL") = file.add_floats(std::vector<float>(18, 1), "VEC3");
      file.attribute(name) = accessor >= 0 ? accessor : file.add_floats({1, 0, 0, 1}, "VEC4");
      if (std::string(name) == "TANGENT" && accessor == 2) file.attribute(name) = 0;  // places, of three
      const Character character = import_file(file, std::string("ornament_") + name + what);
      INFO(name << " " << what);
      CHECK(character.positions.size() == 6);
      CHECK(character.tangents.empty());
      CHECK(noted(character, std::string("its ") + name + " cannot be read: left out"));
    }
  }
}

TEST_CASE("primitives_keep_their_ranges_materials_and_place_in_the_mesh") {
  const Character character = import_file(two_bars(), "two_primitives");
  check_covered(character);
  REQUIRE(character.primitives.size() == 2);
  const PrimitiveSpan &first = character.primitives[0], &second = character.primitives[1];
  CHECK(first.material.empty());
  CHECK(first.index == 0);
  CHECK(second.material == "Rope");
  CHECK(second.index == 2);  // the point is no primitive of triangles
  CHECK(second.sharer == -1);
  CHECK(second.first_vertex == 6);
  CHECK(second.first_triangle == 4);
  for (size_t v = 0; v < 6; ++v)  // as their accessors have them
    CHECK(character.positions[second.first_vertex + v] == character.positions[v] + Vector3(3, 0, 0));
}

TEST_CASE("primitives_of_the_same_accessors_share_vertices_and_keep_triangles_of_their_own") {
  TinyFile file = two_bars();
  nlohmann::json third = primitives_of(file)[0];
  third["indices"] = file.add<uint16_t>({0, 1, 3}, "SCALAR", 5123);
  third["material"] = 1;
  primitives_of(file).push_back(third);
  const Character character = import_file(file, "shared_accessors");
  check_covered(character);
  REQUIRE(character.primitives.size() == 3);
  const PrimitiveSpan& shared = character.primitives[2];
  CHECK(character.positions.size() == 12);
  CHECK(shared.sharer == 0);
  CHECK(shared.first_vertex == 0);
  CHECK(shared.vertex_count == 6);
  CHECK(shared.first_triangle == 8);
  CHECK(shared.triangle_count == 1);
  CHECK(shared.material == "Rope");
  CHECK(shared.index == 3);
}

TEST_CASE("primitives_that_share_places_and_no_other_accessor_have_vertices_of_their_own") {
  TinyFile file = bar();
  nlohmann::json second = primitives_of(file)[0];
  second["attributes"]["COLOR_0"] = file.add_floats(std::vector<float>(18, 0.5f), "VEC3");
  primitives_of(file).push_back(second);
  const Character character = import_file(file, "shared_places");
  check_covered(character);
  REQUIRE(character.primitives.size() == 2);
  CHECK(character.primitives[1].sharer == -1);
  CHECK(character.positions.size() == 12);
}

TEST_CASE("a_mesh_that_two_nodes_show_has_its_primitives_twice") {
  TinyFile file = two_bars();
  file.json["nodes"].push_back({{"name", "twin"}, {"mesh", 0}, {"skin", 0}});
  file.json["scenes"][0]["nodes"].push_back(3);
  const Character character = import_file(file, "shown_twice");
  check_covered(character);
  REQUIRE(character.primitives.size() == 4);
  CHECK(character.primitives[1].mesh == 0);
  CHECK(character.primitives[2].mesh == 1);
  CHECK(character.primitives[3].index == 2);
  CHECK(character.primitives[3].first_vertex == 18);
}

TEST_CASE("triangles_without_area_are_left_out_of_their_own_primitive") {
  TinyFile file = two_bars();
  primitives_of(file)[0]["indices"] = file.add<uint16_t>({0, 1, 1, 0, 1, 2, 2, 2, 3}, "SCALAR", 5123);
  const Character character = import_file(file, "flat_triangles");
  check_covered(character);
  CHECK(character.primitives[0].triangle_count == 1);
  CHECK(character.primitives[1].first_triangle == 1);
  CHECK(character.primitives[1].triangle_count == 4);
}

TEST_CASE("a_mesh_of_no_vertices_has_no_primitives") {
  TinyFile file = bar();
  nlohmann::json& none = file.json["accessors"].emplace_back(file.json["accessors"][0]);
  none["count"] = 0;
  const auto accessor = file.json["accessors"].size() - 1;
  nlohmann::json empty = file.json["meshes"][0];
  empty["primitives"] = nlohmann::json::array({{{"attributes", {{"POSITION", accessor}}}}});
  file.json["meshes"].insert(file.json["meshes"].begin(), empty);
  file.json["nodes"][1]["mesh"] = 0;
  file.json["nodes"][2]["mesh"] = 1;
  const Character character = import_file(file, "no_vertices");
  check_covered(character);
  CHECK(character.meshes.size() == 1);
  CHECK(character.primitives.size() == 1);
}

TEST_CASE("what_a_unit_of_the_file_is_stays_known") {
  TinyFile file = bar();
  CHECK(import_file(file, "unit").unit_m == 1);
  CHECK(import_gltf(file.write("unit_stated"), {.unit_m = 0.25}).unit_m == 0.25);
  file.attribute("POSITION") =
      file.add_floats({0, 0, 0, 100, 0, 0, 0, 100, 0, 100, 100, 0, 0, 200, 0, 100, 200, 0}, "VEC3");
  CHECK(import_file(file, "unit_centimetres").unit_m == 0.01);
}

TEST_CASE("primitives_of_characters_have_all_of_their_vertices_and_triangles") {
  const std::filesystem::path folder = SINEW_SHARED_DIR "/characters";
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no characters in " << folder << "; set SINEW_SHARED_DIR");
    return;
  }
  size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    for (const char* name : {"file.glb", "file.gltf", "file.vrm"}) {
      if (!std::filesystem::exists(entry.path() / name)) continue;
      const Character character = import_gltf((entry.path() / name).string());
      INFO(entry.path());
      check_covered(character);
      std::set<size_t> with_primitives;
      for (const PrimitiveSpan& primitive : character.primitives) with_primitives.insert(primitive.mesh);
      CHECK(with_primitives.size() == character.meshes.size());
      ++files;
    }
  CHECK(files > 5);
}
