// seeds.cpp  Writes what the fuzz targets start from: fuzz_seeds FOLDER, which gets a folder for each target.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <string>

#include "baker/common/files/safetensors.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/creature/creature.hpp"
#include "tests/baker/import/tiny_file.hpp"
#include "tests/fuzz/snapshot_scenes.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path;
  int count = 0;
  explicit Folder(fs::path where) : path(std::move(where)) { fs::create_directories(path); }
  std::string next() { return (path / std::to_string(count++)).string(); }
  void add(std::span<const std::byte> bytes) {
    std::ofstream(next(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  void add(const std::string& text) { add(std::as_bytes(std::span(text))); }
};

void add_packs(Folder to) {
  to.add(test::small_weightless_pack());
  to.add(test::small_character_pack());
  to.add(test::small_levels_pack());
  to.add(test::small_left_out_pack());
  to.add(test::small_rod_pack());
  to.add(test::small_learned_pack());
  to.add(test::small_patch_pack());
  to.add(test::small_model());
  to.add(test::small_chain_model());
  to.add(scenes::soft_block({.cells = 2, .nodes = 4, .coarser_nodes = {4}, .tangents = true, .clip = true})
             .bytes());
  to.add(scenes::soft_block({.cells = 2,
                             .nodes = 4,
                             .network = false,
                             .rods = scenes::RodMatter{.max_displacement = 0.5, .sewn = true, .bar = true},
                             .arms = scenes::ArmMatter{}})
             .bytes());
}

void add_snapshots(Folder to) {
  const std::vector<scenes::PackBytes> packs = fuzz::snapshot_packs();
  for (const scenes::PackBytes& pack : packs) to.add(fuzz::make_actor(pack).clean);
}

void add_tensors(Folder to) {
  baker::write_safetensors(to.next(), test::small_weights());
  baker::write_safetensors(to.next(), test::small_paper_weights());
  baker::write_safetensors(to.next(), test::small_coping_net());
  baker::Safetensors kinds;
  kinds.metadata = {{"a", "b"}};
  kinds.tensors["floats"] = baker::tensor_f32({2, 3}, {1, 2, 3, 4, 5, 6});
  kinds.tensors["integers"] = baker::tensor_i32({2}, {-1, 7});
  kinds.tensors["halves"] = {baker::Dtype::kF16, {2}, {0, 0x3c, 0, 0xc0}};
  kinds.tensors["bytes"] = {baker::Dtype::kU8, {3}, {1, 2, 3}};
  kinds.tensors["doubles"] = {baker::Dtype::kF64, {1}, std::vector<unsigned char>(8)};
  kinds.tensors["flags"] = {baker::Dtype::kBool, {2}, {0, 1}};
  baker::write_safetensors(to.next(), kinds);
}

// Every recipe of the tree, and one with most keys.
void add_recipes(Folder to, const fs::path& assets) {
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(assets))
    if (file.path().extension() == ".json" && file.file_size() < 20000) fs::copy_file(file.path(), to.next());
  to.add(std::string(R"({"damping_ratio": 0.1, "levels": [40, 20], "left_out": ["belly"], "layer_m": 0.01,
    "max_displacement": 0.5, "coreless_joints": ["ear_*"], "unit_m": 0.01, "up": "z", "without_meshes": ["lod*"],
    "regions": [{"name": "belly", "joints": ["spine"], "stiffness": 0.2, "touches_body": true, "kind": "belly",
      "frequency_hz": 3, "intensity": 1.5, "enabled": false, "note": "why"},
     {"name": "cape", "mesh": "Cape", "material": "cloth", "island_at": [0, 1, 0.5]}],
    "rods": [{"name": "tail", "root": "tail_1", "end": "tail_4", "radius_m": 0.02, "density_kg_m3": 900,
      "frequency_hz": 2, "damping_ratio": 0.25, "drag_per_s": 0.5, "gravity": 1, "sag": 0.5, "start": "learned"}],
    "proxies": [{"joint": "hips", "radius_m": 0.1}], "without_proxies": ["hand_*"]})"));
}

// A bar with what the importer knows beside positions and skin.
TinyFile rich_bar() {
  TinyFile file = bar();
  file.attribute("NORMAL") = file.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  file.attribute("TEXCOORD_0") = file.add_floats({0, 0, 1, 0, 0, .5f, 1, .5f, 0, 1, 1, 1}, "VEC2");
  file.attribute("COLOR_0") = file.add<uint8_t>(std::vector<uint8_t>(24, 128), "VEC4", 5121, true);
  file.json["materials"] = {
      {{"name", "skin"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, .5, .5, 1}}}}}};
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.animate(1, "rotation", "LINEAR", {0, .5f, 1}, {0, 0, 0, 1, 0, 0, .2f, .98f, 0, 0, 0, 1});
  file.animate(1, "translation", "CUBICSPLINE", {0, 1}, std::vector<float>(18, 0.5f));
  file.json["extensionsUsed"] = {"VRMC_springBone", "VRMC_node_constraint"};
  file.json["extensions"]["VRMC_springBone"] = {
      {"specVersion", "1.0"},
      {"colliders", {{{"node", 0}, {"shape", {{"sphere", {{"offset", {0, 0, 0}}, {"radius", 0.1}}}}}}}},
      {"colliderGroups", {{{"name", "body"}, {"colliders", {0}}}}},
      {"springs",
       {{{"name", "hair"},
         {"colliderGroups", {0}},
         {"joints",
          {{{"node", 0}, {"stiffness", 1.0}, {"hitRadius", 0.02}, {"dragForce", 0.4}, {"gravityPower", 0.1}},
           {{"node", 1}}}}}}}};
  file.json["nodes"][1]["extensions"]["VRMC_node_constraint"] = {
      {"specVersion", "1.0"},
      {"constraint", {{"roll", {{"source", 0}, {"rollAxis", "X"}, {"weight", 0.5}}}}}};
  return file;
}

void add_characters(Folder to, const fs::path& assets) {
  to.add(bar().glb());
  to.add(rich_bar().glb());
  baker::CreatureRecipe creature = baker::read_creature_recipe((assets / "creature/creature.json").string());
  creature.clips.resize(1);
  creature.key_rate_hz = 2;
  to.add(baker::make_creature(creature, baker::kFewestCreatureVertices));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  const fs::path out = argv[1], assets = fs::path(SINEW_SOURCE_DIR) / "assets";
  add_packs(Folder(out / "pack"));
  add_snapshots(Folder(out / "snapshot"));
  add_tensors(Folder(out / "safetensors"));
  add_recipes(Folder(out / "recipe"), assets);
  add_characters(Folder(out / "gltf"), assets);
  return 0;
}
