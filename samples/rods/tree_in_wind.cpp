// tree_in_wind.cpp  A young tree in a gusting wind.
#include <cstdio>

#include "samples/rods/run_scene.hpp"
#include "samples/rods/scenes.hpp"
#include "tests/scenes/branching_rod.hpp"
#include "tests/scenes/wind.hpp"

namespace sinew::sample {
namespace {

constexpr double kDt_s = 1.0 / 60;
// Of leaves, across the wind: what they add to the width of the twigs that carry them.
constexpr double kFoliage_m = 0.09;
constexpr float kLeafyDensity = 4;  // twigs weigh this much more with their leaves

}  // namespace

Story tree_in_wind(double seconds) {
  test::BranchingRod tree = test::TreeGrower(test::kYoungTree, test::Timber{}, 3).grow();
  Actor actor{std::move(tree.segments), {{0.16f, 0.10f, 0.065f}, {0.19f, 0.125f, 0.08f}, 10, 2}, {}};
  std::vector<double> widths;
  for (uint32_t i = 0; i < actor.segments.size(); ++i) {
    const bool leafy = tree.order[i] == 3;
    if (leafy) actor.leafy.push_back(i);
    if (leafy) actor.segments[i].density_kg_m3 *= kLeafyDensity;
    widths.push_back(2 * static_cast<double>(actor.segments[i].radius_m) + (leafy ? kFoliage_m : 0));
  }
  rods::RodBatch batch;
  const rods::StrandDef strand{actor.segments};
  accept(rods::RodBatch::create({&strand, 1}, {}, &batch));

  Story story{.name = "tree",
              .title = {},
              .actors = {actor},
              .view = {.yaw_deg = 12, .pitch_deg = 9, .margin = 1.2f}};
  const test::Wind wind;
  const Eigen::Vector3d crown(0, 2, 0);
  run_scene({.batch = &batch,
             .dt_s = kDt_s,
             .seconds = seconds,
             .moments_s = {0, 0.29 * seconds, 0.47 * seconds, 0.62 * seconds, 0.8 * seconds, 0.95 * seconds},
             .drive = [&](double t) { test::blow(batch, 0, actor.segments, widths, wind, t, kDt_s); },
             .caption =
                 [&](double t) {
                   char text[64];
                   std::snprintf(text, sizeof text, "%.2f s   wind %.1f m/s", t,
                                 test::wind_at(wind, crown, t).norm());
                   return std::string(text);
                 }},
            &story);
  char title[160];
  std::snprintf(title, sizeof title, "Tree of %u segments in gusts from the left", story.measured.segments);
  story.title = title;
  story.columns = 3;
  return story;
}

}  // namespace sinew::sample
