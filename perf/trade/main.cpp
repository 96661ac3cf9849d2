// main.cpp  perf_trade_rods: time and iterations to a residual, for solvers, starts, rods and scenes, as CSV.
//
//   perf_trade_rods OUT.csv [--quick] [--scene NAME] [--solver NAME] [--network WEIGHTS] [--examples FILE]
// Cases whose lines are in OUT.csv already are left out, so that a run that was stopped goes on; --quick
// begins anew, with a few small cases; --scene and --solver leave out the
// cases of others; --network and --examples add the starts `learned` and `knn`. The first line tells the
// multiply-add peak of the process that began the file.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>

#include "baker/common/files/kept_files.hpp"
#include "kernels/isa.hpp"
#include "perf/help.hpp"
#include "perf/rods/peak.hpp"
#include "perf/rods/start_files.hpp"
#include "perf/trade/measure.hpp"

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

struct Request {
  std::string out, scene, solver, network, examples;
  bool quick = false;
};

int run(const Request& request, std::span<const TradeStart> starts) {
  const std::set<std::string> done = request.quick ? std::set<std::string>() : done_in(request.out);
  std::FILE* file = std::fopen(request.out.c_str(), request.quick ? "w" : "a");
  if (file == nullptr) {
    std::fprintf(stderr, "perf_trade_rods: %s cannot be written; give another path\n", request.out.c_str());
    return 2;
  }
  if (done.empty()) {
    std::fprintf(file, "# %s, multiply-add peak %.1f GFLOP/s\n%s\n", sinew::simd::active_isa(), peak_gflops(),
                 kColumns);
  }
  const std::vector<TradeCase> cases = trade_cases(starts, request.quick);
  for (size_t i = 0; i < cases.size(); ++i) {
    const bool wanted = (request.solver.empty() || request.solver == cases[i].solver->name) &&
                        (request.scene.empty() || request.scene == cases[i].scene->name);
    if (!wanted || done.contains(key_of(cases[i]))) continue;
    std::fputs(lines_of(cases[i]).c_str(), file);
    std::fflush(file);
    std::fprintf(stderr, "%zu of %zu: %s\n", i + 1, cases.size(), key_of(cases[i]).c_str());
  }
  return std::fclose(file) == 0 ? 0 : 2;
}

int run(const Request& request) {
  std::vector<TradeStart> starts(trade_starts().begin(), trade_starts().end());
  std::unique_ptr<StartNetwork> network;
  std::unique_ptr<ExampleFile> examples;
  if (!request.examples.empty()) {
    examples = std::make_unique<ExampleFile>(request.examples);
    starts.push_back(
        {.name = "knn", .start = sinew::rods::RodStart::kContinued, .correction = examples->nearest()});
  }
  if (!request.network.empty()) {
    network = std::make_unique<StartNetwork>(request.network);
    starts.push_back(
        {.name = "learned", .start = sinew::rods::RodStart::kLearned, .network = network->net()});
  }
  return run(request, starts);
}

bool parse(int argc, char** argv, Request* out) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    std::string* value = word == "--solver"     ? &out->solver
                         : word == "--scene"    ? &out->scene
                         : word == "--network"  ? &out->network
                         : word == "--examples" ? &out->examples
                                                : nullptr;
    if (word == "--quick") {
      out->quick = true;
    } else if (value != nullptr) {
      if (++i == argc) return false;
      *value = argv[i];
    } else if (word[0] != '-' && out->out.empty()) {
      out->out = word;
    } else {
      return false;
    }
  }
  const auto named = [&](const TradeSolver& solver) { return solver.name == out->solver; };
  const auto set = [&](const TradeScene& scene) { return scene.name == out->scene; };
  return !out->out.empty() && (out->solver.empty() || std::ranges::any_of(trade_solvers(), named)) &&
         (out->scene.empty() || std::ranges::any_of(trade_scenes(), set));
}

}  // namespace

constexpr const char* kUsage =
    "usage: perf_trade_rods OUT.csv [--quick] [--scene chain|helix|tree|collisions] "
    "[--solver direct|cg|local] [--network WEIGHTS] [--examples FILE]";

int main(int argc, char** argv) {
  if (sinew::perf::gives_help(argc, argv, kUsage)) return 0;
  Request request;
  if (!parse(argc, argv, &request)) {
    std::fprintf(stderr, "%s\n", kUsage);
    return 2;
  }
  try {
    for (const std::string& input : {request.network, request.examples}) sinew::baker::keep_file(input);
    sinew::baker::promise_file(request.out);
    return run(request);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "perf_trade_rods: %s\n", problem.what());
    return 2;
  }
}
