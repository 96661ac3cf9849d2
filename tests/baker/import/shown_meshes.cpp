// shown_meshes.cpp  Of levels of detail and hidden variants one is baked, and the note says which are not.
#include "baker/import/meshes/shown_meshes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

// The bar once for each name, all on its skin.
TinyFile bars(const std::vector<std::string>& names) {
  TinyFile file = bar();
  file.json["nodes"][2]["name"] = names.front();
  for (size_t i = 1; i < names.size(); ++i) {
    file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
    file.json["nodes"].push_back({{"name", names[i]}, {"mesh", 0}, {"skin", 0}});
  }
  return file;
}

std::vector<std::string> shown(const TinyFile& file, const ImportOptions& options = {}) {
  const Character character = import_gltf(file.write("shown"), options);
  std::vector<std::string> names;
  for (const MeshSpan& mesh : character.meshes)
    names.push_back(character.nodes[static_cast<size_t>(mesh.node)].name);
  return names;
}

std::string notes(const TinyFile& file) {
  std::string all;
  for (const std::string& note : import_gltf(file.write("shown")).notes) all += note + "\n";
  return all;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("names_of_meshes_to_keep_must_be_there") {
  const TinyFile file = bars({"body_LOD0", "body_LOD1"});
  CHECK_THROWS_WITH(shown(file, {.with_meshes = {"body_LOD7"}}),
                    Catch::Contains("with_meshes") && Catch::Contains("no mesh is named 'body_LOD7'"));
}

TEST_CASE("of_levels_of_detail_the_finest_is_shown_however_it_is_written") {
  CHECK(shown(bars({"body_LOD1", "body_LOD0", "body_LOD2"})) == Names{"body_LOD0"});
  CHECK(shown(bars({"Body.lod.1", "Body.lod.2"})) == Names{"Body.lod.1"});
  CHECK(shown(bars({"LOD0_body", "LOD1_body.001"})) == Names{"LOD0_body"});
  CHECK(shown(bars({"bodyLOD0", "bodyLOD1", "hat_LOD1"})) == Names{"bodyLOD0", "hat_LOD1"});
  CHECK(shown(bars({"melody1", "melody2"})).size() == 2);
  CHECK(shown(bars({"Body", "body_LOD1", "BODY-lod2"})) == Names{"Body"});
  CHECK(shown(bars({"bodylod0", "bodylod1", "body_LOD2Shape"})) == Names{"bodylod0", "body_LOD2Shape"});
  const TinyFile file = bars({"body_LOD0", "body_LOD1"});
  CHECK_THAT(notes(file), Catch::Contains("'body_LOD1'") && Catch::Contains("with_meshes"));
  CHECK(shown(file, {.with_meshes = {"body_LOD1"}}).size() == 2);
  CHECK(shown(file, {.without_meshes = {"body_LOD0"}}) == Names{"body_LOD1"});
}

TEST_CASE("levels_of_detail_may_be_groups_or_listed_by_an_extension") {
  TinyFile groups = bars({"body", "body"});
  groups.json["nodes"].push_back({{"name", "LOD0"}, {"children", {2}}});
  groups.json["nodes"].push_back({{"name", "LOD1"}, {"children", {3}}});
  groups.json["scenes"][0]["nodes"] = {0, 4, 5};
  CHECK(shown(groups).size() == 1);
  groups.json["nodes"][3]["name"] = "coarse_body";
  CHECK(shown(groups) == Names{"body"});
  TinyFile listed = bars({"body", "coarse", "coarser"});
  listed.json["nodes"][2]["extensions"]["MSFT_lod"]["ids"] = {3, 4};
  CHECK(shown(listed) == Names{"body"});
}

TEST_CASE("what_is_not_visible_is_left_out_with_all_below_it") {
  TinyFile file = bars({"body", "armour", "helmet"});
  file.json["nodes"][3]["extensions"]["KHR_node_visibility"]["visible"] = false;
  file.json["nodes"][3]["children"] = {4};
  file.json["scenes"][0]["nodes"] = {0, 2, 3};
  file.json["extensionsRequired"] = {"KHR_node_visibility"};
  CHECK(shown(file) == Names{"body"});
  CHECK_THAT(notes(file), Catch::Contains("'armour', 'helmet'"));
  CHECK(shown(file, {.with_meshes = {"armour"}}) == Names{"body", "armour"});
  file.json["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = false;
  CHECK_THROWS_AS(shown(file), BadInput);
}

TEST_CASE("copies_by_instancing_are_noted_and_refused_where_they_are_required") {
  TinyFile file = bars({"buttons"});
  file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 0;
  CHECK_THAT(notes(file), Catch::Contains("EXT_mesh_gpu_instancing is not followed"));
  file.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  CHECK_THROWS_WITH(shown(file), Catch::Contains("EXT_mesh_gpu_instancing"));
  file.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  CHECK(shown(file).size() == 1);
}
