// import_gltf.cpp  Unusable files are refused by one line that names the file and the place; what can be
// mended is, with a note.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>

#include "baker/common/bad_input.hpp"
#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;
namespace fs = std::filesystem;

namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN();

// The refusal, after checking its form.
std::string refusal(const std::string& path, const ImportOptions& options = {}) {
  try {
    import_gltf(path, options);
  } catch (const BadInput& error) {
    const std::string line = error.what();
    CHECK(line.find('\n') == std::string::npos);
    CHECK(line.find(path) == 0);
    CHECK(line.find("; ") != std::string::npos);  // how to mend
    return line;
  }
  return "imported";
}

bool noted(const Character& character, const std::string& text) {
  return std::any_of(character.notes.begin(), character.notes.end(),
                     [&](const auto& note) { return note.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("files_of_another_kind_are_refused_by_what_they_look_like") {
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {std::string("Kaydara FBX Binary  \0\x1a", 22), "begins like an FBX; export the character as glTF"},
      {"; FBX 7.4.0 project file\n", "begins like an FBX"},
      {std::string("SINEWPK\0\6\0\0\0", 12), "begins like a baked .sinew; give the glTF or VRM"},
      {"BLENDER-v300", "begins like a Blender file"},
      {"<?xml version=\"1.0\"?><COLLADA/>", "begins like XML"},
      {"PK\3\4 and more", "begins like a zip archive; unpack it"},
      {"\x89PNG\r\n", "begins like a PNG picture"},
      {"dear artist,\nhere is the wolf", "begins like a text; export"},
      {std::string("\x10\0\0\0\0\0\0\0{\"a\":1}", 15), "begins like a .safetensors"},
      {std::string("\1\2\3\xff zzz"), "begins like the bytes 01 02 03 ff"},
      {"[1, 2]", "begins like a text"},
      {"{\"regions\": []}", "is JSON of another kind"},
  };
  for (const auto& [bytes, says] : kinds) {
    const std::string line = refusal(write_bytes("other.glb", bytes));
    INFO(line);
    CHECK(line.find("not a glTF file: it " + says) != std::string::npos);
  }
  const std::string folder = fs::temp_directory_path().string();
  CHECK_THAT(refusal(folder), Catch::Contains("this is a directory"));
}

TEST_CASE("faulty_files_are_refused_by_name_and_place") {
  struct Fault {
    const char* name;
    std::function<void(TinyFile&)> make;
    const char* says;
  };
  const std::vector<Fault> faults = {
      {"no_skin", [](TinyFile& f) { f.json["nodes"][2].erase("skin"); }, "this file has no skin"},
      {"no_mesh", [](TinyFile& f) { f.json["nodes"][2].erase("mesh"); }, "shows no mesh"},
      {"mesh_index", [](TinyFile& f) { f.json["nodes"][2]["mesh"] = 7; }, "node 2: names mesh 7"},
      {"skin_index", [](TinyFile& f) { f.json["nodes"][2]["skin"] = 7; }, "node 2: names skin 7"},
      {"skin_joint", [](TinyFile& f) { f.json["skins"][0]["joints"][1] = 9; }, "skin 0: names node 9"},
      {"skin_joint_twice",
       [](TinyFile& f) {
         f.json["skins"][0]["joints"] = {1, 1};
       },
       "skin 0: names node 1 twice"},
      {"skin_empty", [](TinyFile& f) { f.json["skins"][0]["joints"] = nlohmann::json::array(); },
       "skin 0: has no joints"},
      {"bind_count", [](TinyFile& f) { f.json["accessors"][4]["count"] = 1; }, "has 1 matrices for 2 joints"},
      {"bind_flat", [](TinyFile& f) { f.bytes.replace(f.bytes.size() - 128, 64, 64, '\0'); },
       "matrix 0 is not finite or flattens"},
      {"cycle", [](TinyFile& f) { f.json["nodes"][1]["children"] = {0}; }, "is its own ancestor"},
      {"own_child", [](TinyFile& f) { f.json["nodes"][2]["children"] = {2}; },
       "node 2 'body': is its own ancestor"},
      {"two_parents", [](TinyFile& f) { f.json["nodes"][2]["children"] = {1}; },
       "node 1 'upper': is the child of two"},
      {"child_index", [](TinyFile& f) { f.json["nodes"][2]["children"] = {-1}; }, "names child -1"},
      {"scene_node",
       [](TinyFile& f) {
         f.json["scenes"][0]["nodes"] = {0, 2, 17};
       },
       "scene 0: names node 17"},
      {"short_translation",
       [](TinyFile& f) {
         f.json["nodes"][1]["translation"] = {1, 2};
       },
       "translation: has 2 numbers"},
      {"short_matrix",
       [](TinyFile& f) {
         f.json["nodes"][0]["matrix"] = {1, 2};
       },
       "matrix: has 2 numbers"},
      {"accessor_index", [](TinyFile& f) { f.attribute("POSITION") = 99; }, "POSITION: names accessor 99"},
      {"accessor_type", [](TinyFile& f) { f.attribute("POSITION") = 2; },
       "4 numbers an element instead of 3"},
      {"accessor_count", [](TinyFile& f) { f.json["accessors"][0]["count"] = 7; },
       "do not fit into bufferView 0"},
      {"accessor_offset", [](TinyFile& f) { f.json["accessors"][0]["byteOffset"] = 4; },
       "do not fit into bufferView 0"},
      {"accessor_huge", [](TinyFile& f) { f.json["accessors"][2]["byteOffset"] = 18446744073709551615u; },
       "do not fit into"},
      {"view_index", [](TinyFile& f) { f.json["accessors"][2]["bufferView"] = 44; }, "names bufferView 44"},
      {"view_end", [](TinyFile& f) { f.json["bufferViews"][0]["byteLength"] = 5000; },
       "of buffer 0, which has"},
      {"view_stride", [](TinyFile& f) { f.json["bufferViews"][0]["byteStride"] = 8; }, "byteStride of 8"},
      {"buffer_index", [](TinyFile& f) { f.json["bufferViews"][0]["buffer"] = 3; }, "names buffer 3"},
      {"buffer_length",
       [](TinyFile& f) {
         f.json["buffers"] = {{{"byteLength", 100000}}};
       },
       "byteLength"},
      {"weights_count", [](TinyFile& f) { f.json["accessors"][2]["count"] = 5; },
       "WEIGHTS_0: has 5 elements for 6 vertices"},
      {"joint_index", [](TinyFile& f) { f.bytes[72] = 2; }, "vertex 0 is weighted to joint 2 of a skin of 2"},
      {"joint_floats", [](TinyFile& f) { f.attribute("JOINTS_0") = 2; },
       "JOINTS_0: does not hold unsigned integers"},
      {"index_range", [](TinyFile& f) { f.bytes[192] = 6; }, "index 0 is 6, there are 6 vertices"},
      {"index_floats", [](TinyFile& f) { f.json["meshes"][0]["primitives"][0]["indices"] = 2; },
       "does not hold unsigned integers"},
      {"restart", [](TinyFile& f) { f.bytes.replace(196, 2, "\xff\xff"); }, "primitive restart"},
      {"nan_position",
       [](TinyFile& f) { f.attribute("POSITION") = f.add_floats(std::vector<float>(18, kNan), "VEC3"); },
       "vertex 0 is NaN"},
      {"far_position",
       [](TinyFile& f) { f.attribute("POSITION") = f.add_floats(std::vector<float>(18, 1e30f), "VEC3"); },
       "10,000 km"},
      {"no_position",
       [](TinyFile& f) { f.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION"); },
       "no mesh of this file has triangles"},
      {"only_lines", [](TinyFile& f) { f.json["meshes"][0]["primitives"][0]["mode"] = 1; },
       "no mesh of this file has triangles"},
      {"sparse_index",
       [](TinyFile& f) {
         const int at = f.add<uint16_t>({6}, "SCALAR", 5123), to = f.add_floats({1, 1, 1}, "VEC3");
         f.json["accessors"][0]["sparse"] = {{"count", 1},
                                             {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                                             {"values", {{"bufferView", to}}}};
       },
       "sparse index 6 is past"},
      {"sparse_count",
       [](TinyFile& f) {
         f.json["accessors"][0]["sparse"] = {{"count", -1},
                                             {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                                             {"values", {{"bufferView", 0}}}};
       },
       "sparse count"},
      {"draco", [](TinyFile& f) { f.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
       "without mesh compression"},
      {"animation_node",
       [](TinyFile& f) {
         f.animate(40, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 1, 1});
       },
       "names node 40"},
      {"animation_accessor",
       [](TinyFile& f) {
         f.animate(0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 1, 1});
         f.json["animations"][0]["samplers"][0]["output"] = 77;
       },
       "names accessor 77"},
      {"animation_sampler",
       [](TinyFile& f) {
         f.animate(0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 1, 1});
         f.json["animations"][0]["channels"][0]["sampler"] = 4;
       },
       "names sampler 4"},
      {"deep_json",
       [](TinyFile& f) {
         nlohmann::json deep = 1;
         for (int i = 0; i < 500; ++i) deep = nlohmann::json::array({deep});
         f.json["extras"] = deep;
       },
       "nested deeper than 200"},
      {"many_nodes",
       [](TinyFile& f) {
         for (int i = 0; i < 65536; ++i) f.json["nodes"].push_back(nlohmann::json::object());
       },
       "65539 nodes"},
      {"many_skins",
       [](TinyFile& f) {
         for (int i = 0; i < 1024; ++i) f.json["skins"].push_back(f.json["skins"][0]);
       },
       "1025 skins"},
      {"version_1", [](TinyFile& f) { f.json.erase("asset"); }, "asset"},
  };
  for (const Fault& fault : faults) {
    TinyFile file = bar();
    fault.make(file);
    const std::string line = refusal(file.write(fault.name));
    INFO(fault.name << ": " << line);
    CHECK(line.find(fault.says) != std::string::npos);
  }
}

TEST_CASE("faulty_paths_and_options_are_refused") {
  CHECK(refusal("/nowhere/at_all.glb").find("no such file") != std::string::npos);
  CHECK(refusal("/").find("not a file") != std::string::npos);
  CHECK(refusal("/dev/zero").find("not a file") != std::string::npos);
  CHECK(refusal(write_bytes("empty.glb", "")).find("empty") != std::string::npos);
  CHECK(refusal(write_bytes("text.gltf", "hello, world")).find("not a glTF file") != std::string::npos);
  const std::string path = bar().write("good");
  CHECK(refusal(path, {.up = 'x'}).find("option up") != std::string::npos);
  CHECK(refusal(path, {.unit_m = -1}).find("unit_m") != std::string::npos);
  CHECK(refusal(path, {.max_vertices = 5}).find("more than 5 vertices") != std::string::npos);
}

TEST_CASE("three_million_vertices_are_refused_by_their_count_alone") {
  TinyFile file = bar();
  file.json["accessors"][0]["count"] = 3'000'000;  // far more than there are bytes: nothing may be read
  CHECK(refusal(file.write("many")).find("more than 1000000 vertices") != std::string::npos);
}

TEST_CASE("a_missing_buffer_file_is_named_and_the_working_directory_is_not_searched") {
  TinyFile file = bar();
  file.json["buffers"] = {{{"byteLength", file.bytes.size()}, {"uri", "away.bin"}}};
  const std::string path = write_bytes("external.gltf", file.json.dump());
  CHECK(refusal(path).find("away.bin") != std::string::npos);

  const fs::path before = fs::current_path(), elsewhere = fs::path(path).parent_path() / "elsewhere";
  fs::create_directory(elsewhere);
  fs::rename(write_bytes("away.bin", file.bytes), elsewhere / "away.bin");
  fs::current_path(elsewhere);
  CHECK(refusal(path).find("away.bin") != std::string::npos);
  fs::current_path(before);

  write_bytes("away.bin", file.bytes);
  CHECK(import_gltf(path).positions.size() == 6);
}

TEST_CASE("a_file_cut_anywhere_is_refused") {
  const std::string whole = bar().glb();
  for (size_t length = 0; length < whole.size(); ++length) {
    const std::string path = write_bytes("cut.glb", whole.substr(0, length));
    CHECK_THROWS_AS(import_gltf(path), BadInput);
  }
}

TEST_CASE("weights_that_cannot_be_right_are_mended_and_noted") {
  TinyFile file = bar();
  file.attribute("WEIGHTS_0") = file.add_floats(
      {2, 0, 0, 0, kNan, 1, 0, 0, -1, .5f, 0, 0, .5f, .5f, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  const Character character = import_gltf(file.write("weights"));
  CHECK(noted(character, "1 weights are NaN"));
  CHECK(noted(character, "1 weights are negative"));
  CHECK(noted(character, "2 vertices have weights that do not sum to one"));
  CHECK(noted(character, "1 vertices have no weight"));
  for (const Influences& skin : character.skin) {
    double sum = 0;
    for (double weight : skin.weight) sum += weight;
    CHECK(sum == Approx(1).margin(1e-15));
  }
  CHECK(character.skin[4].joint[0] == 0);  // no weights: the skin's first joint, the mesh node hangs on none
  CHECK(character.skin[2].joint[0] == 1);
}

TEST_CASE("the_same_note_of_several_places_is_one_line") {
  TinyFile file = bar();
  auto& primitives = file.json["meshes"][0]["primitives"];
  for (int i = 0; i < 3; ++i) primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  const Character character = import_gltf(file.write("notes"));
  CHECK(std::count(character.notes.begin(), character.notes.end(),
                   "mesh 0 'bar' primitive 1 and 2 more: points or lines: left out") == 1);
}

TEST_CASE("bytes_flipped_anywhere_never_crash_the_importer") {
  TinyFile rich = bar();
  rich.attribute("COLOR_0") = rich.add_floats(std::vector<float>(18, 0.5f), "VEC3");
  rich.animate(1, "rotation", "CUBICSPLINE", {0, 1}, std::vector<float>(24, 0.5f));
  const std::string whole = rich.glb();
  std::mt19937 random(1);
  size_t imported = 0, refused = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  while (std::chrono::steady_clock::now() < end) {
    std::string bytes = whole;
    for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
      bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    const std::string path = write_bytes("flipped.glb", bytes);
    try {
      const Character character = import_gltf(path);
      for (const Clip& clip : character.clips)
        skin_positions(character, joint_matrices(character, &clip, 0.4));
      ++imported;
    } catch (const BadInput&) {
      ++refused;
    }
  }
  CHECK(imported > 0);
  CHECK(refused > 0);
}

TEST_CASE("meshes_named_by_the_recipe_are_left_out") {
  TinyFile file = bar();
  file.json["nodes"].push_back({{"name", "sword"}, {"mesh", 1}});
  file.json["meshes"].push_back(file.json["meshes"][0]);
  file.json["meshes"][1]["name"] = "steel";
  file.json["scenes"][0]["nodes"] = {0, 2, 3};
  const std::string path = file.write("meshes");
  const auto with = [&](std::vector<std::string> names) {
    ImportOptions options;
    options.without_meshes = std::move(names);
    return options;
  };
  CHECK_THAT(refusal(path, with({"swrod"})),
             Catch::Contains("no mesh is named 'swrod'; the nearest is 'sword'"));
  CHECK_THAT(refusal(path, with({"steal*"})), Catch::Contains("'steal*'"));
  CHECK_THAT(refusal(path, with({"*"})), Catch::Contains("leaves every mesh out"));
  CHECK(import_gltf(path).positions.size() == 12);
  for (const char* name : {"sword", "steel", "sw*"}) {
    const Character character = import_gltf(path, with({name}));
    CHECK(character.positions.size() == 6);
    CHECK(noted(character, "1 of 2 meshes are left out"));
  }
}

TEST_CASE("characters_from_5_cm_to_50_m_are_in_metres") {
  const auto height_of_scaled = [](double scale) {
    TinyFile file = bar();
    file.json["nodes"][0]["scale"] = {scale, scale, scale};
    const Character character = import_gltf(file.write("tall"));
    double high = 0;
    for (const Vector3& p : character.positions) high = std::max(high, p.y());
    return high;
  };
  for (const double height : {0.05, 1.8, 18.0, 30.0, 49.9})
    CHECK(height_of_scaled(height / 2) == Approx(height));
  CHECK(height_of_scaled(79.0 / 2) == Approx(0.79));
}
