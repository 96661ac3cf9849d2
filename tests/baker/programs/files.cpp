// files.cpp  What the programs write is whole, shown by `info`, and absent after a refusal.
#include <nlohmann/json.hpp>

#include "baker/common/files/read_file.hpp"
#include "baker/common/files/write_file.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/bake.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew::baker;
using namespace sinew::test;

namespace {

// A small packed character and the weights that it was made with.
struct Files {
  TemporaryFolder folder;
  std::string weights = folder.file("w.safetensors"), pack = folder.file("c.sinew");
  Files() {
    write_safetensors(weights, small_weights());
    write_file(pack, small_character_pack());
  }
};

}  // namespace

TEST_CASE("damaged_packs_are_refused_by_every_command_that_reads_one") {
  const Files files;
  const std::string good = read_text(files.pack), bad = files.folder.file("bad.sinew");
  const auto refuse = [&](const std::string& bytes, const std::string& word) {
    write_file(bad, bytes);
    check_refused({"info", bad}, {bad, word});
    check_refused({"check", bad, files.weights}, {bad, word});
  };
  refuse("", "the pack is empty");
  refuse(good.substr(0, 40), "ends inside its header");
  refuse(good.substr(0, good.size() / 2), "truncated");
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 4);
  refuse(flipped, "damaged");
  std::string older = good;
  older[8] = 0;
  refuse(older, "sinew-bake character IN.glb --recipe R.json --tissue");
  refuse("GIF89a, and more", "not a .sinew pack");
}

TEST_CASE("info_shows_a_character_to_people_and_to_machines") {
  const Files files;
  const ProgramResult table = bake({"info", files.pack}), json = bake({"info", "--json", files.pack});
  CHECK(table.exit_code == 0);
  for (const char* word : {"character", "belly", "swing", "felt_step", "modal", "first_hz", "made_by",
                           "a key that nobody knows", "unit_m", "primitives", "first_triangle"})
    CHECK_THAT(table.out, Catch::Contains(word));
  const auto description = nlohmann::json::parse(json.out);
  CHECK(description["kind"] == "character");
  CHECK(description["character"]["vertices"] == 12);
  CHECK(description["character"]["unit_m"].get<double>() == Approx(0.01));
  CHECK(description["character"]["tangents"] == true);
  CHECK(description["meshes"][0]["vertices"] == 12);
  CHECK(description["primitives"][0]["material"] == "skin");
  CHECK(description["primitives"][1]["material"].is_null());
  CHECK(description["primitives"][1]["index"] == 2);
  CHECK(description["primitives"][1]["vertices"] == 12);
  CHECK(description["primitives"][1]["first_triangle"] == 8);
  CHECK(description["network"]["channels"] == std::vector<int>{5, 3});
  CHECK(description["regions"][1]["name"] == "tip");
  CHECK(description["regions"][1]["modes"] == 2);
  CHECK(description["regions"][1]["first_hz"].get<double>() == Approx(20 / (2 * 3.14159265)));
  CHECK(description["clips"][0]["seconds"].get<double>() == Approx(0.1));
  CHECK(description["tiers"][1]["error_mm"].is_null());
  CHECK(description["metadata"]["made_by"] == "a key that nobody knows");
}

TEST_CASE("info_shows_a_weights_file_with_its_unknown_keys") {
  const Files files;
  const ProgramResult table = bake({"info", files.weights}), json = bake({"info", "--json", files.weights});
  CHECK_THAT(table.out, Catch::Contains("layers.1.W_y") && Catch::Contains("a key that nobody knows"));
  const auto description = nlohmann::json::parse(json.out);
  CHECK(description["kind"] == "safetensors");
  CHECK(description["tensors"].size() == 10);
  CHECK(description["metadata"]["made_by"] == "a key that nobody knows");
}

TEST_CASE("a_refused_bake_leaves_the_old_file_as_it_was") {
  const Files files;
  const std::string output = files.folder.file("m.sinew");
  write_file(output, std::string_view("old"));
  Safetensors broken = small_weights();
  broken.tensors.erase("layers.1.W_h");
  write_safetensors(files.folder.file("broken"), broken);
  const size_t entries = files.folder.entries();
  check_refused({"model", files.folder.file("broken"), "-o", output},
                {"broken", "tensor 'layers.1.W_h' is missing"});
  check_refused({"model", files.pack, "-o", output}, {files.pack, "not a safetensors file"});
  CHECK(read_text(output) == "old");
  CHECK(files.folder.entries() == entries);
  check_refused({"model", files.weights, "-o", files.folder.file("no/folder/m.sinew")},
                {"cannot be written"});
}

TEST_CASE("the_paper_s_network_is_packed_as_a_model") {
  const Files files;
  const std::string paper = files.folder.file("paper"), output = files.folder.file("m.sinew");
  write_safetensors(paper, small_paper_weights());
  CHECK(bake({"model", paper, "-o", output}).exit_code == 0);
  CHECK(nlohmann::json::parse(bake({"info", "--json", output}).out)["kind"] == "model");
}

TEST_CASE("an_output_that_is_an_input_is_refused_before_anything_is_read") {
  const TemporaryFolder folder;
  const auto made = [&](const std::string& name) {
    write_file(folder.file(name), std::string_view("no such thing as this is asked for"));
    return folder.file(name);
  };
  // None of them is what its program reads: whoever reads it first says so instead.
  const std::string character = made("x.glb"), recipe = made("r.json"), weights = made("w.safetensors");
  const std::string soft = folder.file("soft.glb"), hard = folder.file("hard.glb");
  std::filesystem::create_symlink(character, soft);
  std::filesystem::create_hard_link(character, hard);
  const std::string dotted = folder.file("./x.glb"), out = folder.file("c.sinew");
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& output) {
    check_refused(arguments, {output, "is the input; give another name"});
  };
  for (const std::string& output : {character, dotted, soft, hard})
    refused({"character", character, "-o", output}, output);
  refused({"character", soft, "-o", character}, character);
  refused({"character", character, "--recipe", recipe, "-o", recipe}, recipe);
  refused({"character", character, "-o", out, "--preview", character}, character);
  refused({"character", character, "--tissue", weights, "-o", weights}, weights);
  refused({"model", weights, "--precision", "int8", "--calibrate", recipe, "-o", recipe}, recipe);
  refused({"truth", character, "--motion", "shake", "-o", character}, character);
  refused({"model", weights, "-o", weights}, weights);
  refused({"creature", recipe, "-o", recipe}, recipe);
  refused({"audit", character, "-o", character}, character);
  check_refused({"character", character, "-o", out, "--preview", out}, {out, "would be written twice"});
  CHECK(read_text(character) == "no such thing as this is asked for");
  CHECK(read_text(recipe) == read_text(character));
  CHECK(read_text(weights) == read_text(character));
  CHECK(!std::filesystem::exists(out));
}

TEST_CASE("a_buffer_beside_a_gltf_is_an_input_too") {
  const TemporaryFolder folder;
  const std::string gltf = folder.file("x.gltf"), buffer = folder.file("x.bin");
  write_file(buffer, std::string_view("0123"));
  write_file(gltf, std::string_view(
                       R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "x.bin"}]})"));
  check_refused({"character", gltf, "-o", buffer}, {buffer, "is the input; give another name"});
  CHECK(read_text(buffer) == "0123");
}

TEST_CASE("runs_that_are_not_known_to_be_of_a_plan_are_not_added_to") {
  const TemporaryFolder folder;
  const std::string plan = SINEW_SOURCE_DIR "/assets/patches/paper.json", data = folder.path();
  write_file(folder.file("plan.json"), std::string_view("{}"));
  check_refused({"patch-data", "--plan", plan, "-o", data}, {data, "not known to be of", "another folder"});
  std::filesystem::rename(folder.file("plan.json"), folder.file("sphere-train-1.safetensors"));
  check_refused({"patch-data", "--plan", plan, "-o", data}, {data, "not known to be of", "another folder"});
  CHECK_FALSE(std::filesystem::exists(folder.file("plan.json")));
}
