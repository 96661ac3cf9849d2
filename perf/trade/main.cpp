// main.cpp  perf_trade_rods: time and iterations to a residual, for solvers, starts, rods and scenes, as CSV.
//
//   perf_trade_rods OUT.csv [--quick]
// Cases whose lines are in OUT.csv already are left out, so that a run that was stopped goes on; --quick
// begins anew, with a few small cases. The first line tells the multiply-add peak of the process that began
// the file.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>

#include "perf/rods/peak.hpp"
#include "perf/trade/measure.hpp"
#include "simd/isa.hpp"

namespace {

using namespace sinew::perf;

constexpr const char* kColumns =
    "scene,strands,segments,young_pa,solver,start,residual,states,reached,iterations_mean,iterations_most,"
    "inner_mean,us_a_strand,error_lengths";

// The cases that a file holds, whole: a case is written at once. Throws where it holds something else.
std::set<std::string> done_in(const std::string& path) {
  std::set<std::string> out;
  std::ifstream file(path);
  std::string first, columns;
  if (std::getline(file, first) && (!std::getline(file, columns) || columns != kColumns)) {
    throw std::runtime_error(path + ": holds no measurements of this program; give another path");
  }
  for (std::string line; std::getline(file, line);) {
    size_t end = 0;
    for (int i = 0; i < 6 && end != std::string::npos; ++i) end = line.find(',', end + (i > 0));
    if (end != std::string::npos && line[0] != '#') out.insert(line.substr(0, end));
  }
  return out;
}

std::string lines_of(const TradeCase& c) {
  std::string out;
  for (const Reached& r : measure(c)) {
    char text[160];
    std::snprintf(text, sizeof text, ",%.0e,%u,%u,%.2f,%u,%.1f,%.2f,%.1e\n", r.residual, r.states, r.reached,
                  r.iterations_mean, r.iterations_most, r.inner_mean, r.strand_us, r.error);
    out += key_of(c) + text;
  }
  return out;
}

int run(const std::string& path, bool quick) {
  const std::set<std::string> done = quick ? std::set<std::string>() : done_in(path);
  std::FILE* file = std::fopen(path.c_str(), quick ? "w" : "a");
  if (file == nullptr) {
    std::fprintf(stderr, "perf_trade_rods: %s cannot be written; give another path\n", path.c_str());
    return 2;
  }
  if (done.empty()) {
    std::fprintf(file, "# %s, multiply-add peak %.1f GFLOP/s\n%s\n", sinew::simd::active_isa(), peak_gflops(),
                 kColumns);
  }
  const std::vector<TradeCase> cases = trade_cases(quick);
  for (size_t i = 0; i < cases.size(); ++i) {
    if (done.contains(key_of(cases[i]))) continue;
    std::fputs(lines_of(cases[i]).c_str(), file);
    std::fflush(file);
    std::fprintf(stderr, "%zu of %zu: %s\n", i + 1, cases.size(), key_of(cases[i]).c_str());
  }
  return std::fclose(file) == 0 ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc == 3 && std::strcmp(argv[2], "--quick") == 0;
  if (argc < 2 || argv[1][0] == '-' || (argc > 2 && !quick)) {
    std::fprintf(stderr, "usage: perf_trade_rods OUT.csv [--quick]\n");
    return 2;
  }
  try {
    return run(argv[1], quick);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "perf_trade_rods: %s\n", problem.what());
    return 2;
  }
}
