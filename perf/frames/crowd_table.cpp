// crowd_table.cpp  see crowd_table.hpp.
#include "perf/frames/crowd_table.hpp"

#include <algorithm>
#include <cstdio>

#include "baker/common/bad_input.hpp"
#include "perf/frames/crowd_error.hpp"
#include "samples/demo/statistics.hpp"

namespace sinew::perf {
namespace {

using Motions = std::vector<demo::Trajectory>;

Motions read_motions(const demo::CharacterFile& character, const std::vector<std::string>& paths) {
  Motions out;
  for (const std::string& path : paths) {
    out.emplace_back(path, character);
    if (out.back().rate_hz() != out.front().rate_hz())
      throw baker::BadInput(path + ": has another rate than " + paths[0] + "; simulate it again");
  }
  return out;
}

void put_row(const std::string& motion, const CrowdDef& def, const CrowdError& crowd, const ErrorSums& sums) {
  const demo::Spread cpu_us = demo::spread_of(crowd.cpu_us);
  std::printf("%s,%u,%g,%zu,%.1f,%.1f,%.4f", motion.c_str(), def.instances, double{def.budget_us},
              crowd.cpu_us.size(), cpu_us.median, cpu_us.p99, sums.skinning_mm());
  for (const double share : {sums.left_alone(), sums.cut(), sums.expected(), sums.expected_of_mm(),
                             sums.measured(), sums.weighted_expected(), sums.weighted_measured()})
    std::printf(",%.4f", share);
  std::puts("");
}

void put_rows(const Motions& motions, const CrowdDef& def, const CrowdError& crowd) {
  ErrorSums all;
  for (const ErrorSums& sums : crowd.motions) all.add(sums);
  put_row("all", def, crowd, all);
  std::vector<std::string> told;
  for (const demo::Trajectory& motion : motions) {
    const std::string name = motion.name_at(0);
    if (std::ranges::count(told, name) > 0) continue;
    ErrorSums of_name;
    for (size_t m = 0; m < motions.size(); ++m)
      if (motions[m].name_at(0) == name) of_name.add(crowd.motions[m]);
    put_row(name, def, crowd, of_name);
    told.push_back(name);
  }
}

}  // namespace

void put_crowd_errors(const demo::CharacterFile& character, const CrowdOptions& options) {
  const Motions motions = read_motions(character, options.truths);
  std::puts(
      "motion,instances,budget_us,frames,cpu_us_p50,cpu_us_p99,skinning_mm,left_alone,cut,expected,expected_"
      "of_mm,measured,"
      "weighted_expected,weighted_measured");
  for (const float budget_us : options.budgets_us) {
    const CrowdDef def{options.instances, budget_us, options.mode};
    put_rows(motions, def, measure_crowd(character, motions, def));
    std::fflush(stdout);
  }
}

}  // namespace sinew::perf
