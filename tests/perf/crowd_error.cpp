// crowd_error.cpp  perf_frames --crowd on a coarse creature: what it measures, and what was expected.
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "baker/common/read_file.hpp"
#include "baker/trade/error.hpp"
#include "baker/trade/write_tiers.hpp"
#include "tests/baker/programs/creature_hop.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

// Baked, so that runs by baked costs are all alike.
constexpr double kShownCost_us = 4, kModalCost_us = 20, kNetworkCost_us = 80;

std::string tiered(const CreatureHop& hop) { return hop.folder.file("tiered.sinew"); }

// The creature with its tiers' errors along that hop.
void bake_tiers(const CreatureHop& hop) {
  const auto character = baker::LoadedPack::from_file(hop.pack);
  const std::vector<baker::TrueSurface> surfaces = {{hop.truth, character.view()}};
  const baker::Yardstick yardstick(character, surfaces);
  const auto row = [](Tier tier, double us, const baker::Error& error) {
    return baker::Row{.name = {},
                      .kind = "tier",
                      .tier = tier,
                      .warm = {us, us, us},
                      .cold = {},
                      .error = error,
                      .dominated_by = {}};
  };
  const std::vector<baker::Row> rows = {
      row(Tier::kSkinning, 0, yardstick.of_skinning()),
      row(Tier::kExtrapolate, kShownCost_us, yardstick.of_extrapolation(character, baker::kCarriedTicks)),
      row(Tier::kModal, kModalCost_us, yardstick.of(character, Tier::kModal, 1, 0)),
      row(Tier::kNetwork, kNetworkCost_us, yardstick.of(character, Tier::kNetwork, 1, 0))};
  baker::write_with_tiers(tiered(hop), character, baker::tier_records(rows));
}

const CreatureHop& hop() {
  static const CreatureHop made(
      {.name = "hop_of_crowd", .source = __FILE__, .seconds = "1.5", .more = bake_tiers});
  return made;
}

// The row of the whole crowd, by column.
std::map<std::string, double> crowd(uint32_t instances, double budget_us) {
  const ProgramResult result =
      run_program({SINEW_PERF_FRAMES, tiered(hop()), "--crowd", hop().truth, "--instances",
                   std::to_string(instances), "--budget-us", std::to_string(budget_us), "--work-units"});
  must(result);
  std::istringstream lines(result.out);
  std::string heads, row;
  REQUIRE((std::getline(lines, heads) && std::getline(lines, row)));
  CHECK_THAT(row, Catch::StartsWith("all,"));
  std::istringstream names(heads), values(row);
  std::map<std::string, double> out;
  for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');)
    if (name != "motion") out[name] = std::stod(value);
  return out;
}

}  // namespace

// sinew-demo follows the same truth with an instance of its own.
TEST_CASE("a_crowd_of_one_is_off_what_the_demo_is_off") {
  const std::string path = hop().folder.file("report.json");
  must(run_program({SINEW_DEMO, tiered(hop()), "--truth", hop().truth, "--report", path}));
  double skinning_mm = 0, sinew_mm = 0;
  const auto frames = nlohmann::json::parse(baker::read_text(path)).at("frames");
  for (const auto& frame : frames) {
    skinning_mm += frame.at("error_mm").at("skinning").get<double>();
    sinew_mm += frame.at("error_mm").at("sinew").get<double>();
  }
  const auto row = crowd(1, 1e9);
  REQUIRE(static_cast<double>(frames.size()) == row.at("frames"));
  CHECK(row.at("skinning_mm") == Approx(skinning_mm / static_cast<double>(frames.size() - 1)).epsilon(1e-3));
  CHECK(row.at("measured") == Approx(sinew_mm / skinning_mm).epsilon(1e-3));
}

// What is simulated is held for 30 ticks at least. It blends in over the first 12, which on average loses
// half of what these were to save, 0.2 of the whole; and it begins without a past and swings for half a
// second until that is forgotten, which is allowed as much again. A crowd begins anew blended in, where
// nothing moves yet; what was baked has blended in over the first 12 of 90 ticks, which is worth 0.02 at
// most.
TEST_CASE("what_a_crowd_under_a_budget_is_off_is_what_was_expected_but_for_its_changes") {
  for (const double budget_us : {50.0, 100.0, 150.0, 1e9}) {
    const auto row = crowd(8, budget_us);
    const double measured = row.at("measured"), expected = row.at("expected_of_mm");
    INFO(budget_us << " us: measured " << measured << ", expected " << expected);
    CHECK(measured > expected - 0.02);
    CHECK(measured < expected + 0.4 * (1 - expected));
    if (budget_us < 1e9) CHECK(row.at("weighted_measured") < measured);
  }
}

TEST_CASE("a_crowd_without_room_is_off_what_skinning_is") {
  const auto row = crowd(8, 1);
  CHECK(row.at("expected") == 1);
  CHECK(row.at("measured") == Approx(1).epsilon(1e-4));
}

TEST_CASE("what_is_no_truth_of_a_crowd_s_character_is_refused_by_name") {
  const ProgramResult result = run_program({SINEW_PERF_FRAMES, tiered(hop()), "--crowd", hop().weights});
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK_THAT(result.error, Catch::StartsWith("perf_frames: ") && Catch::Contains("is not a trajectory"));
}
