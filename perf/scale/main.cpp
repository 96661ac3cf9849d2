// main.cpp  perf_scale: how time and memory grow with instances, vertices and workers; CSV to stdout.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "perf/scale/groups.hpp"
#include "perf/scale/record.hpp"

namespace {

using namespace sinew;

struct Options {
  std::vector<std::string> packs;
  int rounds = 31;
};

// The one nearest to the paper's 6,890.
const demo::CharacterFile& usual(const std::vector<demo::CharacterFile>& characters) {
  const auto off = [](const demo::CharacterFile& c) {
    return std::abs(static_cast<int>(c.view.character->vertex_count) - 6890);
  };
  return *std::ranges::min_element(characters, {}, off);
}

void run(const Options& options) {
  std::vector<demo::CharacterFile> characters;
  for (const std::string& pack : options.packs) characters.push_back(demo::open_character(pack));
  perf::put_header();
  perf::measure_parts(usual(characters), options.rounds);
  perf::measure_vertices(characters, options.rounds);
  perf::measure_crowds(usual(characters), options.rounds);
  perf::measure_sleep(usual(characters));
  perf::measure_batches(usual(characters), options.rounds);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Times ticks of characters as they grow in number and size; CSV to standard output");
  app.add_option("packs", options.packs, "C.sinew..., one character at several resolutions")->required();
  app.add_option("--rounds", options.rounds, "repetitions behind each median")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
    return 0;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "perf_scale: %s\n", problem.what());
    return 2;
  }
}
