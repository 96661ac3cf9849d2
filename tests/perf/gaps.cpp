// gaps.cpp  perf_gaps tells what each gap leaves, and refuses a truth that is too short for one.
#include <catch2/catch.hpp>

#include "tests/perf/hop_of_crowd.hpp"

using namespace sinew::test;

TEST_CASE("the_longer_a_gap_the_worse_it_is_and_one_of_a_tick_is_made_up_for") {
  const ProgramResult result =
      run_program({SINEW_PERF_GAPS, hop_of_crowd().tiered(), hop_of_crowd().long_truth()});
  must(result);
  std::map<std::string, std::map<int, Row>> tiers;
  for (const Row& row : rows_of(result.out))
    tiers[row.at("tier")][static_cast<int>(number(row, "gap_ticks"))] = row;
  CHECK(tiers.size() == 2);
  for (const auto& [tier, gaps] : tiers) {
    INFO(tier);
    REQUIRE(gaps.size() == 5);
    double before = 0;
    for (const auto& [ticks, row] : gaps) {
      INFO(ticks << " ticks");
      if (ticks <= 8) CHECK(number(row, "in_gap") > before);
      before = number(row, "in_gap");
      CHECK(number(row, "without_gap") < number(row, "in_gap"));
      for (const char* of : {"to_4", "to_12", "to_40", "beyond_both_percent"}) CHECK(number(row, of) >= 0);
    }
    // Within a tenth over the forty ticks after it.
    CHECK(number(gaps.at(1), "to_40") < 1.1 * number(gaps.at(1), "without_gap"));
    CHECK(number(gaps.at(8), "to_40") > 2 * number(gaps.at(8), "without_gap"));
  }
}

TEST_CASE("a_truth_too_short_for_the_longest_gap_is_refused_before_anything_is_told") {
  const ProgramResult result =
      run_program({SINEW_PERF_GAPS, hop_of_crowd().tiered(), hop_of_crowd().truth()});
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK_THAT(result.error,
             Catch::StartsWith("perf_gaps: " + hop_of_crowd().truth()) && Catch::Contains("too short"));
}
