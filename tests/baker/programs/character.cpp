// character.cpp  From a recipe to a packed character through the programs alone.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "baker/common/files/read_file.hpp"
#include "baker/common/files/write_file.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/bake.hpp"
#include "tests/baker/programs/fill_once.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew::baker;
using namespace sinew::test;

namespace {

const std::string kAssets = SINEW_SOURCE_DIR "/assets/creature/";

struct Creature {
  TemporaryFolder folder;
  std::string glb = folder.file("creature.glb"), weights = folder.file("w.safetensors"),
              pack = folder.file("c.sinew");
  Creature() {
    fill_once(folder, "creature", {SINEW_BAKE, __FILE__, kAssets + "creature.json"}, [this] {
      REQUIRE(bake({"creature", kAssets + "creature.json", "-o", glb, "--vertices", "800"}).exit_code == 0);
    });
    write_safetensors(weights, small_weights());
  }
  std::vector<std::string> bake_arguments(const std::string& output) const {
    return {"character", glb, "--recipe", kAssets + "tissue.json", "--tissue", weights, "-o", output};
  }
};

}  // namespace

TEST_CASE("the_creature_bakes_to_a_character_with_clips_regions_and_the_same_bytes_twice") {
  const Creature creature;
  const ProgramResult result = bake(creature.bake_arguments(creature.pack));
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("regions") && Catch::Contains("idle"));
  const auto description = nlohmann::json::parse(bake({"info", "--json", creature.pack}).out);
  CHECK(description["clips"].size() >= 4);
  CHECK(description["regions"].size() >= 3);
  CHECK(description["character"]["joints"].get<int>() >= 20);
  REQUIRE(bake(creature.bake_arguments(creature.folder.file("again"))).exit_code == 0);
  CHECK(read_text(creature.pack) == read_text(creature.folder.file("again")));
}

TEST_CASE("info_lists_the_bones_and_meshes_of_a_file_that_is_to_be_baked") {
  const Creature creature;
  const std::string broken = creature.folder.file("broken.glb");
  write_file(broken, std::string_view("GIF89a, and more"));
  check_refused({"info", broken}, {"broken.glb", "not a glTF file"});
  CHECK_THAT(bake({"info", creature.glb}).out, Catch::Contains("bones") && Catch::Contains("spine_"));
  const auto description = nlohmann::json::parse(bake({"info", "--json", creature.glb}).out);
  CHECK(description["bones"][0]["parent"] == "-");
  size_t moved = 0, shown = 0;
  for (const auto& bone : description["bones"]) moved += bone["vertices"].get<size_t>();
  for (const auto& mesh : description["meshes"]) shown += mesh["vertices"].get<size_t>();
  CHECK(moved == shown);
  CHECK(moved > 500);
  CHECK(description["character"]["unit_m"] == 1);
  CHECK(description["primitives"][0]["vertices"].get<size_t>() <= shown);
  CHECK(description["primitives"][0]["mesh"] == description["meshes"][0]["name"]);
  CHECK(description["clips"].size() >= 4);
}

// Its loose pieces meet the body in corners and edges of the cage, about which they would turn at no
// frequency.
TEST_CASE("a_real_vrm_bakes_with_its_springs_and_a_soft_trunk_to_a_pack_that_opens") {
  const std::string vrm = SINEW_SHARED_DIR "/characters/godette_vrm0/file.vrm";
  if (!std::filesystem::exists(vrm)) {
    WARN("skipped: no " << vrm << "; set SINEW_SHARED_DIR");
    return;
  }
  const TemporaryFolder folder;
  const std::string pack = folder.file("godette.sinew"), recipe = folder.file("recipe.json");
  write_file(recipe, std::string_view(R"({"regions": [
    {"name": "trunk", "joints": ["pelvis_Armature", "chest_Armature"]},
    {"name": "legs", "joints": ["thigh.l_Armature", "thigh.r_Armature"]}]})"));
  const ProgramResult result = bake({"character", vrm, "--recipe", recipe, "-o", pack});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  const auto description = nlohmann::json::parse(bake({"info", "--json", pack}).out);
  CHECK(description["rods"].size() == 8);
  CHECK(description["regions"].size() >= 3);
  for (const auto& region : description["regions"]) CHECK(region["first_hz"].get<double>() > 1);
  const ProgramResult without = bake({"character", vrm, "-o", pack});
  REQUIRE(without.exit_code == 0);
  CHECK_THAT(without.out, Catch::Contains("spring bone") && Catch::Contains("rod of 1 bone"));
  CHECK(nlohmann::json::parse(bake({"info", "--json", pack}).out)["regions"].empty());
}

TEST_CASE("springs_of_a_file_swing_no_further_than_their_skin_holds_and_a_note_says_which") {
  const std::string vrm = SINEW_SHARED_DIR "/characters/godette_vrm0/file.vrm";
  if (!std::filesystem::exists(vrm)) {
    WARN("skipped: no " << vrm << "; set SINEW_SHARED_DIR");
    return;
  }
  const TemporaryFolder folder;
  const std::string pack = folder.file("godette.sinew");
  const ProgramResult result = bake({"character", vrm, "--quick", "-o", pack});
  must(result);
  must(bake({"audit", pack}));
  CHECK_THAT(result.out, Catch::Contains("note: 'FrontHair_Center_R' may swing by") &&
                             !Catch::Contains("'HairBall_L' may swing"));
  for (const auto& rod : nlohmann::json::parse(bake({"info", "--json", pack}).out)["rods"])
    if (rod["name"] == "HairBall_L") CHECK(rod["turn_limit_rad"] == 0);  // none, as the file says
}

TEST_CASE("a_table_says_of_every_part_what_it_is_and_why") {
  const Creature creature;
  const ProgramResult result = bake(creature.bake_arguments(creature.pack));
  INFO(result.out);
  CHECK_THAT(result.out,
             Catch::Contains("part") && Catch::Contains("evidence") && Catch::Contains("limit/size"));
  CHECK_THAT(result.out, Catch::Contains("painted") && Catch::Contains("soft tissue"));
}

TEST_CASE("a_character_without_soft_tissue_takes_weights_and_leaves_them_out_with_a_note") {
  const Creature creature;
  const std::string recipe = creature.folder.file("recipe.json");
  const auto bake_with = [&](const char* text) {
    write_file(recipe, std::string_view(text));
    const ProgramResult result = bake(
        {"character", creature.glb, "--recipe", recipe, "--tissue", creature.weights, "-o", creature.pack});
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    CHECK_THAT(result.out, Catch::Contains("nothing is soft tissue") && Catch::Contains("is not used"));
    return nlohmann::json::parse(bake({"info", "--json", creature.pack}).out);
  };
  const auto rods = bake_with(R"({"regions": [], "rods": [{"root": "tail_1"}]})");
  CHECK(rods["rods"].size() == 1);
  CHECK(rods["network"]["model"] == "none");
  const auto rigid = bake_with(R"({"regions": [], "rods": []})");
  CHECK_FALSE(rigid.contains("rods"));
  CHECK(rigid["regions"].empty());
}

TEST_CASE("a_learned_start_of_rods_is_baked_with_its_weights_and_refused_without") {
  const Creature creature;
  const std::string recipe = creature.folder.file("learned.json"),
                    coping = SINEW_SOURCE_DIR "/assets/weights/coping_8.safetensors";
  write_file(
      recipe,
      std::string_view(
          R"({"regions": [], "rods": [{"root": "tail_1", "start": "learned"}, {"root": "ear_l_1"}]})"));
  std::vector<std::string> arguments = {"character", creature.glb, "--recipe", recipe, "-o", creature.pack};
  check_refused(arguments, {"learned.json", "rod 'tail_1'", "give --rods W.safetensors"});
  arguments.insert(arguments.end(), {"--rods", creature.weights});
  check_refused(arguments,
                {"w.safetensors", "'sinew.model' is 'alt_conv_lstm'; rods start from a coping_net"});
  arguments.back() = creature.folder.file("none");
  check_refused(arguments, {"none"});
  CHECK_FALSE(std::filesystem::exists(creature.pack));
  arguments.back() = coping;
  must(bake(arguments));
  auto description = nlohmann::json::parse(bake({"info", "--json", creature.pack}).out);
  CHECK(description["rods"][0]["start"] != description["rods"][1]["start"]);
  CHECK(description["rod_network"]["latent"] == 8);
  write_file(recipe, std::string_view(R"({"regions": [], "rods": [{"root": "tail_1"}]})"));
  CHECK_THAT(bake(arguments).out, Catch::Contains("no rod's recipe says \"start\": \"learned\""));
  write_file(recipe, std::string_view(R"({"regions": [], "rods": []})"));
  CHECK_THAT(bake(arguments).out, Catch::Contains("nothing swings as a rod"));
}

TEST_CASE("rods_that_are_unlike_those_that_a_learned_start_was_trained_on_are_named") {
  const Creature creature;
  const std::string recipe = creature.folder.file("learned.json"),
                    weights = creature.folder.file("c.safetensors");
  write_file(
      recipe,
      std::string_view(
          R"({"regions": [], "rods": [{"root": "tail_1", "start": "learned"}, {"root": "ear_l_1"}]})"));
  Safetensors coping = read_safetensors(SINEW_SOURCE_DIR "/assets/weights/coping_8.safetensors");
  const auto bake_it = [&](const char* segments, const char* compliances) {
    coping.metadata["trained.segments"] = segments;
    coping.metadata["trained.log_compliances"] = compliances;
    write_safetensors(weights, coping);
    return bake({"character", creature.glb, "--recipe", recipe, "--rods", weights, "-o", creature.pack});
  };
  CHECK(bake_it("2,100", "-30,5").out.find("trained on") == std::string::npos);
  CHECK_THAT(bake_it("30,100", "-30,5").out, Catch::Contains("note: rod 'tail_1'") &&
                                                 Catch::Contains("segments ") &&
                                                 Catch::Contains("trained on 30 to 100"));
  const ProgramResult stiff = bake_it("2,100", "4,5");
  CHECK_THAT(stiff.out, Catch::Contains("rod 'tail_1'") && Catch::Contains("trained on 4 to 5"));
  CHECK(stiff.out.find("rod 'ear_l_1': no rod") == std::string::npos);
  std::filesystem::remove(creature.pack);
  const ProgramResult broken = bake_it("2 to 100", "-30,5");
  CHECK(broken.exit_code == 2);
  CHECK_THAT(broken.error, Catch::Contains("'trained.segments' is '2 to 100'; expected least,most"));
  CHECK_FALSE(std::filesystem::exists(creature.pack));
  coping.metadata.erase("trained.segments");
  write_safetensors(weights, coping);
  CHECK_THAT(
      bake({"character", creature.glb, "--recipe", recipe, "--rods", weights, "-o", creature.pack}).out,
      Catch::Contains("does not say which rods it was trained on"));
}

TEST_CASE("a_region_that_is_clear_of_no_capsule_is_named_as_it_is_baked") {
  const Creature creature;
  auto recipe = nlohmann::json::parse(read_text(kAssets + "tissue.json"));
  recipe["regions"][0]["touches_body"] = true;
  recipe["voxels_high"] = 14;  // quickly
  const auto bake_it = [&] {
    const std::string path = creature.folder.file("recipe.json");
    write_file(path, recipe.dump());
    const ProgramResult result = bake({"character", creature.glb, "--recipe", path, "-o", creature.pack});
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    return result.out;
  };
  const auto capsules = [&] {
    int most = 0;
    const auto description = nlohmann::json::parse(bake({"info", "--json", creature.pack}).out);
    for (const auto& region : description["regions"]) most = std::max(most, region["capsules"].get<int>());
    return most;
  };
  CHECK(bake_it().find("touches_body and") == std::string::npos);
  CHECK(capsules() > 0);
  recipe["proxies"] = {{{"joint", "*"}, {"radius_m", 3}}};
  CHECK_THAT(bake_it(), Catch::Contains("note: region 'belly' says touches_body and touches none of the "));
  CHECK(capsules() == 0);
  recipe["without_proxies"] = {"*"};
  CHECK_THAT(bake_it(),
             Catch::Contains("note: region 'belly' says touches_body and there are no capsules about bones"));
}

TEST_CASE("without_weights_a_character_is_packed_with_its_modes") {
  const Creature creature;
  const ProgramResult result =
      bake({"character", creature.glb, "--recipe", kAssets + "tissue.json", "-o", creature.pack});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  const auto description = nlohmann::json::parse(bake({"info", "--json", creature.pack}).out);
  CHECK(description["network"]["model"] == "none");
  std::vector<std::string> tiers;
  for (const auto& tier : description["tiers"]) tiers.push_back(tier["tier"]);
  CHECK(tiers == std::vector<std::string>{"skinning", "extrapolate", "modal"});
  for (const auto& region : description["regions"]) {
    CHECK(region["modes"].get<int>() >= 6);
    CHECK(region["first_hz"].get<double>() > 1);
    CHECK(region["first_hz"].get<double>() < 30);
  }
}

TEST_CASE("errors_are_those_of_the_character_that_is_baked_and_a_network_that_does_not_pay_is_left_out") {
  Creature creature;
  const auto bake_with = [&](const std::string& weights, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"character", creature.glb, "--recipe", kAssets + "tissue.json",
                                          "--tissue",  weights,      "-o",       creature.pack};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = bake(arguments);
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    return result.out;
  };
  const auto error_of = [&](const std::string& name) {
    const auto description = nlohmann::json::parse(bake({"info", "--json", creature.pack}).out);
    for (const auto& tier : description["tiers"])
      if (tier["tier"] == name) return tier["error_ratio"];
    return nlohmann::json("no such tier");
  };
  const std::string shipped = SINEW_SOURCE_DIR "/assets/weights/creature.safetensors";
  const std::string printed = bake_with(shipped, {});
  CHECK_THAT(printed, !Catch::Contains("left out"));
  // In the shake the truth of its ears goes further than their limit of 1.45 radii; no other part goes so
  // far.
  CHECK_THAT(printed, Catch::Contains("'ear_l' would move by") && !Catch::Contains("'tail' would move by"));
  CHECK(error_of("network").get<double>() < 0.95 * error_of("modal").get<double>());
  CHECK(error_of("modal").get<double>() < 0.3);
  const auto described = nlohmann::json::parse(bake({"info", "--json", creature.pack}).out);
  for (const auto& tier : described["tiers"]) {
    if (tier["tier"] != "modal") continue;
    CHECK(tier["worst_ratio"].get<double>() > tier["error_ratio"].get<double>());  // the median's
    CHECK_THAT(tier["worst_along"].get<std::string>(), Catch::Matches("idle|walk|hop|shake|random or shake"));
  }

  // Weights of random numbers.
  CHECK_THAT(bake_with(creature.weights, {}),
             Catch::Contains("note: the network is left out: on this character"));
  CHECK(error_of("network") == "no such tier");
  CHECK(error_of("modal").get<double>() < 0.3);

  CHECK_THAT(bake_with(creature.weights, {"--keep-network"}), !Catch::Contains("left out"));
  CHECK(error_of("network").is_number());

  bake_with(creature.weights, {"--quick"});
  CHECK(error_of("network").is_null());
  CHECK(error_of("modal").is_null());
}

TEST_CASE("weights_of_the_first_version_are_refused_for_characters") {
  const Creature creature;
  Safetensors old = small_weights();
  old.metadata.erase("base");
  write_safetensors(creature.weights, old);
  check_refused(creature.bake_arguments(creature.pack), {creature.weights, "'base'", "train again"});
}

TEST_CASE("characters_and_weights_that_do_not_fit_leave_no_file") {
  const Creature creature;
  const size_t entries = creature.folder.entries();
  Safetensors paper = small_paper_weights();
  write_safetensors(creature.weights, paper);
  check_refused(creature.bake_arguments(creature.pack),
                {creature.weights, "'inputs' is missing", "paper's wiring"});
  Safetensors broken = small_weights();
  broken.tensors["layers.0.b"] =
      tensor_f32({20}, std::vector<float>(20, std::numeric_limits<float>::quiet_NaN()));
  write_safetensors(creature.weights, broken);
  check_refused(creature.bake_arguments(creature.pack), {"tensor 'layers.0.b' holds NaN"});
  write_file(creature.glb, std::string_view("glTF, but not really"));
  write_safetensors(creature.weights, small_weights());
  check_refused(creature.bake_arguments(creature.pack), {creature.glb});
  CHECK(creature.folder.entries() == entries);
}
