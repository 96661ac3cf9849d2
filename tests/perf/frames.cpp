// frames.cpp  perf_frames runs every scene, each for a second, and tells what its scene is about.
#include <catch2/catch.hpp>

#include "tests/perf/hop_of_crowd.hpp"

using namespace sinew::test;

namespace {

constexpr int kFrames = 60;

std::vector<Row> frames() {
  static const ProgramResult result =
      run_program({SINEW_PERF_FRAMES, hop_of_crowd().tiered(), "--frames", std::to_string(kFrames)});
  must(result);
  return rows_of(result.out);
}

bool is_yardstick(const Row& row) { return row.at("trouble") == "yardstick"; }

}  // namespace

TEST_CASE("every_trouble_of_frames_is_run_and_told_in_order_of_rank") {
  std::map<std::string, int> troubles;
  for (const Row& row : frames()) {
    INFO(row.at("trouble") << " " << row.at("instances") << " " << row.at("budget_us"));
    ++troubles[row.at("trouble")];
    CHECK(number(row, "frames") == kFrames);
    for (const std::string of : {"cpu", "wall", "schedule_us"}) {
      CHECK(number(row, of + "_p50") >= 0);
      CHECK(number(row, of + "_p99") >= number(row, of + "_p50"));
      CHECK(number(row, of + "_p999") >= number(row, of + "_p99"));
      CHECK(number(row, of + "_worst") >= number(row, of + "_p999"));
    }
  }
  for (const std::string trouble :
       {"steady", "cuts", "entrance", "hitch", "worker lost", "neighbour", "hidden", "asleep", "yardstick"})
    CHECK(troubles[trouble] > 0);
}

TEST_CASE("in_every_scene_each_character_has_one_tier_or_none_to_see") {
  for (const Row& row : frames()) {
    if (is_yardstick(row)) continue;
    INFO(row.at("trouble") << " " << row.at("instances") << " " << row.at("budget_us"));
    double sum = 0;
    for (const std::string of : {"network", "modal", "extrapolated", "skinned"}) sum += number(row, of);
    CHECK(sum + number(row, "hidden") > 0);
    CHECK(sum < 1 + 5 * 5e-5);  // each rounded to four digits
    CHECK(number(row, "expected_error") > 0);
    CHECK(number(row, "expected_error") <= 1);
  }
}

TEST_CASE("who_is_looked_away_from_is_hidden_and_who_rests_under_no_load_is_asleep") {
  for (const Row& row : frames()) {
    if (row.at("trouble") == "hidden") CHECK(number(row, "hidden") > 0.9);
    if (row.at("trouble") == "asleep") CHECK(number(row, "hidden") == 0);
    if (row.at("trouble") == "steady") CHECK(number(row, "hidden") == 0);
  }
}

TEST_CASE("fewer_frames_than_a_second_are_refused") {
  const ProgramResult result = run_program({SINEW_PERF_FRAMES, hop_of_crowd().tiered(), "--frames", "59"});
  CHECK(result.exit_code != 0);
  CHECK_THAT(result.error, Catch::Contains("--frames"));
}
