// crowd_error.cpp  perf_frames --crowd on a coarse creature: what it measures, and what was expected.
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "baker/common/files/read_file.hpp"
#include "tests/perf/hop_of_crowd.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

// The row of the whole crowd, by column.
std::map<std::string, double> crowd(uint32_t instances, double budget_us) {
  const ProgramResult result = run_program({SINEW_PERF_FRAMES, hop_of_crowd().tiered(), "--crowd",
                                            hop_of_crowd().truth(), "--instances", std::to_string(instances),
                                            "--budget-us", std::to_string(budget_us), "--work-units"});
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
  const std::string path = hop_of_crowd().file("report.json");
  must(run_program(
      {SINEW_DEMO, hop_of_crowd().tiered(), "--truth", hop_of_crowd().truth(), "--report", path}));
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

// What is simulated is held for 30 ticks at least. It blends in over the first 20, which on average loses
// half of what these were to save, a third of the whole; and it begins without a past and swings for half a
// second and more until that is forgotten, which is allowed two fifths more, and 0.003 for blends of more
// than 20 ticks (character/transition/blend_pace.hpp): in all less than was allowed while what was baked had
// blended in, too. Both the crowd and what was baked begin at rest: where nothing is denied they are the same
// to rounding.
TEST_CASE("what_a_crowd_under_a_budget_is_off_is_what_was_expected_but_for_its_changes") {
  for (const double budget_us : {50.0, 100.0, 150.0, 1e9}) {
    const auto row = crowd(8, budget_us);
    const double measured = row.at("measured"), expected = row.at("expected_of_mm");
    INFO(budget_us << " us: measured " << measured << ", expected " << expected);
    CHECK(measured > expected - 0.001);
    CHECK(measured < expected + 0.003 + (1.0 / 3 + 0.4) * (1 - expected));
    if (budget_us == 1e9) CHECK(measured < expected + 0.001);
    if (budget_us < 1e9) CHECK(row.at("weighted_measured") < measured);
  }
}

TEST_CASE("a_crowd_without_room_is_off_what_skinning_is") {
  const auto row = crowd(8, 1);
  CHECK(row.at("expected") == 1);
  CHECK(row.at("measured") == Approx(1).epsilon(1e-4));
}

TEST_CASE("what_is_no_truth_of_a_crowd_s_character_is_refused_by_name") {
  const ProgramResult result =
      run_program({SINEW_PERF_FRAMES, hop_of_crowd().tiered(), "--crowd", hop_of_crowd().weights()});
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK_THAT(result.error, Catch::StartsWith("perf_frames: ") && Catch::Contains("is not a trajectory"));
}
