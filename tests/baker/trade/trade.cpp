// trade.cpp  sinew-trade on a coarse creature: what it refuses, what it finds, and that it goes on where it
// was.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "baker/common/files/read_file.hpp"
#include "baker/common/files/safetensors.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/measure/true_surface.hpp"
#include "baker/trade/source/truths.hpp"
#include "tests/baker/programs/creature_hop.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using namespace sinew::test;
namespace fs = std::filesystem;

namespace {

ProgramResult trade(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SINEW_TRADE);
  return run_program(arguments);
}

// Exit code 2, one line on stderr that holds the words, no folder.
void check_refused(std::vector<std::string> arguments, const std::string& folder,
                   const std::vector<std::string>& words) {
  arguments.insert(arguments.end(), {"-o", folder});
  const ProgramResult result = trade(arguments);
  INFO(result.error);
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK_THAT(result.error, Catch::StartsWith("sinew-trade: "));
  CHECK(result.error.find('\n') == result.error.size() - 1);
  for (const std::string& word : words) CHECK_THAT(result.error, Catch::Contains(word));
  CHECK_FALSE(fs::exists(folder));
}

// 40 ticks.
const CreatureHop& hop() {
  static const CreatureHop made({.name = "hop_of_trade", .source = __FILE__, .seconds = "1"});
  return made;
}

std::string changed_truth(const std::string& name, const std::function<void(Safetensors&)>& change) {
  Safetensors file = read_safetensors(hop().truth);
  change(file);
  const std::string path = hop().folder.file(name);
  write_safetensors(path, file);
  return path;
}

nlohmann::json rows_of(const std::string& folder) {
  return nlohmann::json::parse(read_text(folder + "/trade.json")).at("rows");
}

nlohmann::json row_of(const nlohmann::json& rows, const std::string& name) {
  for (const auto& row : rows)
    if (row.at("name") == name) return row;
  FAIL("no row " + name);
  return {};
}

}  // namespace

TEST_CASE("unusable_input_of_a_trade_is_refused_by_name_and_leaves_nothing") {
  const std::string out = hop().folder.file("refused"), pack = hop().pack;
  check_refused({hop().folder.file("nowhere.sinew"), "--truth", hop().truth}, out, {"nowhere.sinew"});
  const std::string cut = hop().folder.file("cut.sinew");
  const std::string whole = read_text(pack);
  write_file(cut, whole.substr(0, whole.size() / 2));
  check_refused({cut, "--truth", hop().truth}, out, {cut, "truncated"});
  const std::string model = hop().folder.file("model.sinew");
  must(bake({"model", hop().weights, "-o", model}));
  check_refused({model, "--truth", hop().truth}, out, {model, "without a character"});
  const std::string moved = changed_truth("moved.safetensors", [](Safetensors& file) {
    std::vector<float> places = file.tensors.at("node.rest_position").as_f32();
    places[7] += 0.01f;
    file.tensors["node.rest_position"] = tensor_f32(file.tensors.at("node.rest_position").shape, places);
  });
  check_refused({pack, "--truth", moved}, out, {moved, "control node 2 is not where", "it was baked from"});
  const std::string bare =
      changed_truth("bare.safetensors", [](Safetensors& file) { file.tensors.erase("positions"); });
  check_refused({pack, "--truth", bare}, out, {bare, "no positions", "--positions"});
  check_refused({pack, "--truth", hop().weights}, out, {"is not a trajectory"});
  check_refused({pack, "--truth", hop().truth, "--seconds", "0"}, out, {"--seconds", "0.1"});
  const std::string alone = hop().folder.file("alone.sinew");
  write_file(alone, whole);
  check_refused({alone}, out, {"alone.glb", "--source", "--truth"});
  check_refused({pack, "--truth", hop().truth, "--wrong"}, out, {"--wrong", "--help"});
  write_file(hop().folder.file("file"), std::string_view("no folder"));
  const ProgramResult result =
      trade({pack, "--truth", hop().truth, "-o", hop().folder.file("file") + "/out"});
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.error, Catch::Contains("cannot be made"));
  CHECK(read_text(hop().folder.file("file")) == "no folder");
}

TEST_CASE("an_unknown_clip_or_another_character_s_source_is_refused") {
  const std::string out = hop().folder.file("refused_source");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& word) {
    std::vector<std::string> all = {hop().pack, "-o", out};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult result = trade(all);
    INFO(result.error);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.error, Catch::Contains(word));
    CHECK_FALSE(fs::exists(out));
  };
  refused({"--source", hop().folder.file("nowhere.glb"), "--recipe", hop().recipe}, "nowhere.glb");
  refused({"--source", hop().glb, "--recipe", hop().recipe, "--clip", "swim"}, "no such clip");
  const std::string other = hop().folder.file("other.glb");
  must(bake({"creature", kAssets + "creature/creature.json", "-o", other, "--vertices", "700"}));
  refused({"--source", other, "--recipe", hop().recipe}, "another character");
}

// Costs are times, so equal bytes say that nothing was measured again.
TEST_CASE("a_trade_finds_the_front_bakes_it_and_goes_on_where_it_was_stopped") {
  const std::string out = hop().folder.file("out");
  const std::vector<std::string> arguments = {hop().pack, "--truth", hop().truth, "-o", out};
  const ProgramResult first = trade(arguments);
  INFO(first.error);
  REQUIRE(first.exit_code == 0);
  CHECK(first.error.empty());  // no progress in a pipe
  for (const char* word : {"skinning", "network", "modal", "clip:hop seed 0"})
    CHECK_THAT(first.out, Catch::Contains(word));
  const nlohmann::json rows = rows_of(out);
  const auto ratio = [&](const char* name) { return row_of(rows, name).at("ratio").get<double>(); };
  CHECK(ratio("skinning") == 1);
  // Shares of skinning's error that the evaluation page has for whole hops are half of these bounds.
  CHECK(ratio("network") < 0.2);
  CHECK(ratio("network") < ratio("modal"));
  CHECK(ratio("modal") < 0.5);
  CHECK(ratio("previous frame's displacement") > 0.1);
  for (const nlohmann::json& row : rows) {
    INFO(row.dump());
    const auto in_50 = [&](const char* key) { return row.at("in_50").at(key).get<double>(); };
    CHECK(in_50("mean_mm") != row.at("mean_mm").get<double>());  // the truth has 60 ticks
    CHECK(in_50("worst_mm") <= row.at("worst_mm").get<double>());
    CHECK(in_50("sd_mm") > 0);
    CHECK(in_50("mean_mm") < in_50("p95_mm"));
    CHECK(in_50("p95_mm") <= in_50("worst_mm"));
  }
  CHECK(row_of(rows, "skinning").at("in_50").at("ratio") == 1);
  for (const char* name : {"trade.csv", "trade.json", "trade.svg", "trade.png", "c.sinew"})
    CHECK(fs::file_size(out + "/" + name) > 500);
  const LoadedPack baked = LoadedPack::from_file(out + "/c.sinew"), given = LoadedPack::from_file(hop().pack);
  CHECK(baked.view().tiers.front().error_ratio == 1);
  CHECK(baked.view().tiers.front().cost_us > 0);
  CHECK(std::ranges::equal(baked.view().weights, given.view().weights));
  CHECK(std::ranges::equal(baked.view().strings, given.view().strings));

  const std::string count = std::to_string(rows.size());
  CHECK_THAT(first.out, Catch::Contains(" s; 0 of " + count + " rows taken from " + out + "/measured.json"));

  const std::string csv = read_text(out + "/trade.csv");
  const ProgramResult second = trade(arguments);
  must(second);
  CHECK_THAT(second.out, Catch::Contains(" s; " + count + " of " + count + " rows taken from"));
  CHECK(read_text(out + "/trade.csv") == csv);

  nlohmann::json half = nlohmann::json::parse(read_text(out + "/measured.json"));
  half["rows"].erase(half["rows"].begin() + 3, half["rows"].end());
  write_file(out + "/measured.json", std::string_view(half.dump()));
  must(trade(arguments));
  const nlohmann::json again = rows_of(out);
  CHECK(row_of(again, "skinning") == row_of(rows, "skinning"));
  CHECK(row_of(again, "modal").at("ratio") == row_of(rows, "modal").at("ratio"));

  half = nlohmann::json::parse(read_text(out + "/measured.json"));
  half["rows"][2]["ratio"] = "much";
  half["rows"][3].erase("warm");
  write_file(out + "/measured.json", std::string_view(half.dump()));
  const ProgramResult mended = trade(arguments);
  must(mended);
  CHECK(mended.error == "sinew-trade: " + out + "/measured.json: 2 of " + count +
                            " rows hold no figures of a step; they are measured again\n");
  CHECK(row_of(rows_of(out), rows[2].at("name")).at("ratio") == rows[2].at("ratio"));

  write_file(out + "/measured.json", std::string_view("{\"rows\":"));
  CHECK_THAT(trade(arguments).error, Catch::Contains("measured.json: is no table of rows"));
}

TEST_CASE("without_truth_the_clips_are_simulated_once_and_variants_stand_beside") {
  const std::string out = hop().folder.file("simulated");
  const std::vector<std::string> arguments = {hop().pack,    "--recipe", hop().recipe, "--tissue",
                                              hop().weights, "--clip",   "hop",        "--seconds",
                                              "0.3",         "-o",       out};
  fs::create_directories(out + "/truth");
  write_file(out + "/truth/hop_0_0.2s.safetensors", std::string_view("of another length"));
  const ProgramResult first = trade(arguments);
  must(first);
  CHECK_THAT(first.error, Catch::Contains("what it holds is of other clips"));
  CHECK(std::ranges::count(first.error, '\n') == 1);
  fs::remove(out + "/truth/hop_0_0.2s.safetensors");
  std::vector<fs::path> truths;
  for (const auto& entry : fs::directory_iterator(out + "/truth")) truths.push_back(entry.path());
  REQUIRE(truths.size() == 2);
  const nlohmann::json rows = rows_of(out);
  for (const char* name : {"network, 20 nodes a region", "modal, 60 nodes a region"})
    CHECK(row_of(rows, name).at("kind") == "variant");
  const auto before = fs::last_write_time(truths.front());
  must(trade(arguments));
  CHECK(fs::last_write_time(truths.front()) == before);
}

// Whatever lies in the folder.
TEST_CASE("each_clip_length_and_material_has_a_truth_of_its_own") {
  const TemporaryFolder folder;
  const std::string soft = folder.file("soft.json"), firmer = folder.file("firmer.json");
  nlohmann::json material = nlohmann::json::parse(read_text(hop().recipe));
  material["voxels_high"] = 14;  // quick to simulate
  write_file(soft, std::string_view(material.dump()));
  material["young_soft_pa"] = 1.5 * material["young_soft_pa"].get<double>();
  write_file(firmer, std::string_view(material.dump()));
  const LoadedPack pack = LoadedPack::from_file(hop().pack);
  const auto simulated = [&](const std::string& clip, double seconds, const std::string& recipe) {
    const BakedFrom source{.glb = hop().glb, .recipe = recipe, .weights = {}};
    const std::vector<std::string> paths =
        simulate_clips(source, {clip}, seconds, pack.view(), folder.file("truth"));
    REQUIRE(paths.size() == 2);
    return TrueSurface(paths.front(), pack.view());
  };
  const TrueSurface hopped = simulated("hop", 0.15, soft);
  const TrueSurface walked = simulated("walk", 0.15, soft);
  CHECK(hopped.name() == "clip:hop seed 0 strength 1");
  CHECK(walked.name() == "clip:walk seed 0 strength 1");
  CHECK(simulated("walk", 0.2, soft).motion().ticks() == 12);
  CHECK(simulated("walk", 0.15, firmer).fingerprint() != walked.fingerprint());
  CHECK(simulated("hop", 0.15, soft).fingerprint() == hopped.fingerprint());
  CHECK(std::distance(fs::directory_iterator(folder.file("truth")), {}) == 8);
}
