// jumps.cpp  perf_jumps: how far a change of tier moves a vertex from one frame to the next; CSV to stdout.
//
// Along each of the character's clips, looped, every few ticks anew, an instance changes from what it has to
// a tier: from every tier that may be bought, and from having been left alone, for some ticks, by
// extrapolation, by skinning, or out of view, after the tier nearest to the truth and, for few ticks, after
// the one that is furthest from it. What is told of it: tier_change.hpp. The tier that is not
// simulated all along stands still.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <span>
#include <stdexcept>
#include <string_view>

#include "perf/frames/level_name.hpp"
#include "perf/frames/tier_change.hpp"

namespace {

using namespace sinew;
using namespace sinew::perf;

constexpr double kSeconds = 5;  // of each clip: once around, and over where it begins again

// Those that the scheduler may choose: which of its points are on the front is decided anew at every step.
std::vector<Way> simulated_ways(const world::Asset& asset) {
  std::vector<Way> ways;
  for (const frame::Level& point : std::span(asset.points, asset.point_count))
    ways.push_back({.tier = point.tier, .level = point.graph});
  return ways;
}

struct Left {
  const char* name;
  Way way;
  size_t ticks;
};
constexpr Way kExtrapolated{.tier = Tier::kExtrapolate}, kSkinned{}, kHidden{.hidden = true};
// While it is caught up with, while what was shown is carried on, while it fades, and when it has. Skinning
// is had only where nothing is left to carry on.
constexpr Left kLeft[] = {{"extrapolate for 1", kExtrapolated, 1},
                          {"extrapolate for 2", kExtrapolated, 2},
                          {"extrapolate for 3", kExtrapolated, 3},
                          {"extrapolate for 4", kExtrapolated, 4},
                          {"extrapolate for 9", kExtrapolated, 9},
                          {"extrapolate for 30", kExtrapolated, 30},
                          {"skinning for 30", kSkinned, 30},
                          {"hidden for 2", kHidden, 2},
                          {"hidden for 9", kHidden, 9},
                          {"hidden for 30", kHidden, 30}};

constexpr size_t kFew = 4;  // of the first of these, after the worst tier too

std::string name_of(const world::Asset& asset, const Way& way) {
  constexpr const char* kNames[] = {"skinning", "extrapolate", "network", "", "modal"};
  std::string name = kNames[static_cast<size_t>(way.tier)];
  if (!frame::is_simulated(way.tier) || asset.level_count == 1) return name;
  return name + " on " + level_name(asset.levels[way.level]);
}

bool is_same(const Way& a, const Way& b) { return a.tier == b.tier && a.level == b.level; }

struct Table {
  JumpPlayer& player;
  const std::vector<Way>& ways;  // those that are simulated first
  const std::vector<Run>& runs;
  const std::string& clip;
  double own_m;  // the farthest that a tier itself moves a vertex in a frame

  void tell(const std::string& from, const Way& left, const std::vector<Stay>& stays) const {
    for (size_t w = 0; w < ways.size(); ++w) {
      if (is_same(ways[w], left) || (!frame::is_simulated(left.tier) && !frame::is_simulated(ways[w].tier)))
        continue;
      const Jump jump = largest_jump(player, stays, runs[w], ways[w]);
      const double percent = 100 / player.height_m();
      std::printf("%s,\"%s\",%s,%.3f,%.4f,%.3f,%.4f,%.4f,%.3f,%zu,%zu\n", clip.c_str(), from.c_str(),
                  name_of(player.asset(), ways[w]).c_str(), 1e3 * jump.at_once_m, percent * jump.at_once_m,
                  1e3 * jump.beyond_m, percent * jump.beyond_m, percent * jump.beyond_all_m, percent * own_m,
                  jump.change_tick, jump.after_ticks);
    }
  }
};

// Of those that are baked the one nearest to the truth, which loses most by being left alone, and the one
// furthest from it.
size_t best_of(std::span<const frame::Level> points) {
  return static_cast<size_t>(std::ranges::min_element(points, {}, &frame::Level::error) - points.begin());
}
size_t worst_of(std::span<const frame::Level> points) {
  return static_cast<size_t>(std::ranges::max_element(points, {}, &frame::Level::error) - points.begin());
}

double farthest_step_m(const std::vector<Run>& runs) {
  float most = 0;
  for (const Run& run : runs)
    for (const Steps& steps : run.steps) most = std::max(most, std::ranges::max(steps));
  return static_cast<double>(most);
}

void tell_left_alone(const Table& table) {
  const world::Asset& asset = table.player.asset();
  const std::span points(asset.points, asset.point_count);
  const size_t best = best_of(points), worst = worst_of(points);
  const auto tell = [&](const Left& left, const std::string& name, size_t before) {
    table.tell(name, left.way.hidden ? kSkinned : left.way,
               stays_after(table.player, table.runs[before], left.way, left.ticks));
  };
  for (const Left& left : kLeft) tell(left, left.name, best);
  const std::string after = " after " + name_of(asset, table.ways[worst]);
  for (const Left& left : std::span(kLeft).first(kFew)) tell(left, left.name + after, worst);
}

void run(const demo::CharacterFile& character, const std::string& clip, size_t apart_ticks) {
  JumpPlayer player(character, clip, kSeconds);
  std::vector<Way> ways = simulated_ways(player.asset());
  if (ways.empty()) throw std::runtime_error("the pack has no tier that simulates");
  const size_t simulated = ways.size();
  ways.push_back(kExtrapolated);
  std::vector<Run> runs;
  for (const Way& way : ways) runs.push_back(run_in(player, way, apart_ticks));
  const Table table{player, ways, runs, clip, farthest_step_m(runs)};
  for (size_t f = 0; f < simulated; ++f)
    table.tell(name_of(player.asset(), ways[f]), ways[f], stays_in(runs[f]));
  tell_left_alone(table);
}

// What is looked at before and after a change of transitions: the clips that are held to a bound, and few
// moments of change.
constexpr std::string_view kQuickClips[] = {"idle", "walk", "hop"};
constexpr size_t kApartTicks = 7, kQuickApartTicks = 35;

// Of all clips, one, or the quick ones.
void run_all(const std::string& path, const std::string& clip, bool quick, size_t apart_ticks) {
  const demo::CharacterFile character = demo::open_character(path);
  if (character.view.clips.empty())
    throw std::runtime_error(path + ": the pack has no clips; bake it from a file with animations");
  std::vector<std::string> clips;
  for (size_t i = 0; i < character.view.clips.size(); ++i)
    if (clip.empty() ? !quick || std::ranges::count(kQuickClips, character.clip_name(i)) > 0
                     : character.clip_name(i) == clip)
      clips.push_back(character.clip_name(i));
  if (clips.empty() && clip.empty())
    throw std::runtime_error(path + ": no clip is called idle, walk or hop; sinew-bake info lists them");
  if (clips.empty())
    throw std::runtime_error(path + ": no clip is called '" + clip + "'; sinew-bake info lists them");
  std::puts(
      "clip,from,to,at_once_mm,at_once_percent,beyond_both_mm,beyond_both_percent,beyond_all_percent,"
      "own_step_percent,change_tick,after_ticks");
  for (const std::string& name : clips) run(character, name, apart_ticks);
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{"Distance that a change of tier moves a vertex, for all changes that can happen."};
  std::string path;
  app.add_option("pack", path, "C.sinew")->required();
  std::string clip;
  app.add_option("--clip", clip, "along this one alone; all if not said");
  bool quick = false;
  app.add_flag("--quick", quick, "along idle, walk and hop only, 35 ticks from one change to the next");
  size_t apart_ticks = 0;
  app.add_option("--apart", apart_ticks, "ticks from one change to the next; 7 if not said")
      ->check(CLI::Range(5, 240));
  CLI11_PARSE(app, count, arguments);
  if (apart_ticks == 0) apart_ticks = quick ? kQuickApartTicks : kApartTicks;
  try {
    run_all(path, clip, quick, apart_ticks);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "perf_jumps: %s\n", error.what());
    return 2;
  }
  return 0;
}
