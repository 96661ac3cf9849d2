// main.cpp  perf_frames: whole frames under a budget, in scenes that try to break it; CSV to stdout.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "perf/frames/crowd_table.hpp"
#include "perf/frames/frame_run.hpp"
#include "perf/frames/walls.hpp"
#include "perf/frames/yardstick.hpp"

namespace {

using namespace sinew;
using namespace sinew::perf;

struct Options {
  std::string pack;
  uint32_t frames = 6000;
  std::string only;
  uint32_t characters = 0;  // 0: however many
  CrowdOptions crowd;
};

// The smallest value that `share` of all do not exceed.
double quantile(std::vector<double>& sorted, double share) {
  const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::max<size_t>(rank, 1) - 1];
}

template <class Get>
void put_quantiles(const std::vector<FrameCost>& frames, Get get) {
  std::vector<double> values;
  for (const FrameCost& frame : frames) values.push_back(static_cast<double>(get(frame)));
  std::ranges::sort(values);
  for (const double share : {0.5, 0.99, 0.999, 1.0}) std::printf(",%.4g", quantile(values, share));
}

double share_of_tier(const std::vector<FrameCost>& frames, uint32_t FrameReport::*count, uint32_t instances) {
  double sum = 0;
  for (const FrameCost& frame : frames) sum += frame.report.*count;
  return instances > 0 ? sum / static_cast<double>(frames.size() * instances) : 0;
}

// Of the frames that left somebody below its best tier: the middle one's share of the budget left unspent.
double unspent(const std::vector<FrameCost>& frames, float budget_us) {
  std::vector<double> shares;
  for (const FrameCost& frame : frames)
    if (frame.report.unspent_us > 0)
      shares.push_back(static_cast<double>(frame.report.unspent_us / budget_us));
  std::ranges::sort(shares);
  return shares.empty() ? 0 : quantile(shares, 0.5);
}

double mean_error(const std::vector<FrameCost>& frames) {
  double sum = 0;
  for (const FrameCost& frame : frames) sum += static_cast<double>(frame.report.expected_error);
  return sum / static_cast<double>(frames.size());
}

void put_scene(const Scene& scene, const std::vector<FrameCost>& frames) {
  std::printf("%s,%u,%g,%zu", name_of(scene.trouble), scene.instances, double{scene.budget_us},
              frames.size());
  put_quantiles(frames, [&](const FrameCost& f) { return f.cpu_us / scene.budget_us; });
  put_quantiles(frames, [&](const FrameCost& f) { return f.wall_us / scene.budget_us; });
  put_quantiles(frames, [](const FrameCost& f) { return f.report.schedule_us; });
  for (const auto count :
       {&FrameReport::instances_network, &FrameReport::instances_modal, &FrameReport::instances_extrapolated,
        &FrameReport::instances_skinned, &FrameReport::instances_cut, &FrameReport::instances_dormant,
        &FrameReport::instances_hidden})
    std::printf(",%.4f", share_of_tier(frames, count, scene.instances));
  std::printf(",%.4f,%.4f\n", unspent(frames, scene.budget_us), mean_error(frames));
  std::fflush(stdout);
}

void put_header() {
  std::printf("trouble,instances,budget_us,frames");
  for (const char* of : {"cpu", "wall", "schedule_us"})
    std::printf(",%s_p50,%s_p99,%s_p999,%s_worst", of, of, of, of);
  std::puts(",network,modal,extrapolated,skinned,cut,dormant,hidden,unspent_p50,expected_error");
}

bool is_wanted(const Scene& scene, const Options& options) {
  if (options.characters > 0 && options.characters != scene.instances) return false;
  if (scene.trouble == Trouble::kWalls && !make_walls(scene.instances)) return false;
  return options.only.empty() || options.only == name_of(scene.trouble);
}

void run(const Options& options) {
  const demo::CharacterFile character = demo::open_character(options.pack);
  if (!options.crowd.truths.empty()) return put_crowd_errors(character, options.crowd);
  const PoseTape tape(character, 30);
  put_header();
  for (const Scene& scene : all_scenes()) {
    if (is_wanted(scene, options))
      put_scene(scene, scene.trouble == Trouble::kYardstick
                           ? run_yardstick(scene.budget_us, options.frames)
                           : run_frames(character, tape, scene, options.frames));
  }
}

void add_crowd_options(CLI::App& app, CrowdOptions* o) {
  app.add_option(
      "--crowd", o->truths,
      "only the error of a crowd that follows these trajectories of sinew-bake truth --positions, as "
      "expected and as measured, in fractions of skinning's error");
  app.add_option("--instances", o->instances, "of the crowd")->check(CLI::Range(1, 10'000));
  app.add_option("--budget-us", o->budgets_us, "of the crowd; by default 4000, and none")
      ->check(CLI::PositiveNumber);
  app.add_flag_callback(
      "--work-units", [o] { o->mode = BudgetMode::kWorkUnits; },
      "the crowd's budget is spent by baked costs: the same on any machine");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Steps crowds under a budget in scenes that try to break it; CSV to standard output, times as "
      "fractions of the budget");
  app.add_option("pack", options.pack, "C.sinew")->required();
  app.add_option("--frames", options.frames, "of each scene")->check(CLI::Range(60, 1'000'000));
  app.add_option("--only", options.only,
                 "steady, cuts, entrance, hitch, worker lost, neighbour, walls, hidden, asleep or yardstick");
  app.add_option("--characters", options.characters, "only scenes of so many");
  add_crowd_options(app, &options.crowd);
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
    return 0;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "perf_frames: %s\n", problem.what());
    return 2;
  }
}
