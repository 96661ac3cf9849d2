// jumps.cpp  perf_jumps: how far a change of tier moves a vertex from one frame to the next; CSV to stdout.
//
// Along the character's clips, an instance in one tier changes to another, every seven ticks anew. Told is
// the vertex where it is largest, of
//   at once      how far the surface is, in the first frame, from where it would be without the change
//   beyond both  how much further a vertex moves, from one frame to the next in the 24 after the change,
//                than it did in that frame and the two before it in either tier all along: what no tier's
//                own motion explains
// Surfaces are compared before skinning. The tier that is not simulated stands still by itself.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "perf/frames/pose_tape.hpp"
#include "world/instance.hpp"
#include "world/read.hpp"
#include "world/snapshot.hpp"
#include "world/tick.hpp"

namespace {

using namespace sinew;

constexpr double kSeconds = 8;
constexpr size_t kApart = 7, kWatched = 24;  // ticks

struct Way {
  Tier tier;
  uint32_t level, every;
};

void must(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.message);
}

class Player {
 public:
  explicit Player(const demo::CharacterFile& character) : tape_(character, kSeconds) {
    must(world::open_asset(character.file.bytes(), &asset_));
    must(world::make_instance(asset_, {}, &instance_));
  }
  void step(const Way& way) {
    const std::span<const Matrix34> joints = tape_.joints(static_cast<double>(++tick_) * asset_.tick_s);
    std::ranges::copy(joints, instance_.next_joints);
    instance_.state->has_next = 1;
    instance_.plan = {.ticks = {.ticks = 1, .first_tick_s = asset_.tick_s},
                      .dt_s = asset_.tick_s,
                      .tier = way.tier,
                      .level = way.level,
                      .every = way.every};
    world::step_instance(instance_, {});
  }
  std::vector<float> surface() const {
    std::vector<float> out(size_t{3} * asset_.vertex_count());
    world::read_positions(instance_,
                          {.space = Space::kBind, .out = out.data(), .capacity = asset_.vertex_count()});
    return out;
  }
  std::vector<std::byte> save() const {
    std::vector<std::byte> state(world::snapshot_bytes(instance_));
    must(world::save(instance_, state));
    return state;
  }
  void restore(const std::vector<std::byte>& state, size_t tick) {
    must(world::restore(instance_, state));
    tick_ = tick;
  }
  const world::Asset& asset() const { return asset_; }
  double height_m() const { return static_cast<double>(asset_.pack.character->height_m); }

 private:
  perf::PoseTape tape_;
  world::Asset asset_;
  world::Instance instance_;
  size_t tick_ = 0;
};

using Surface = std::vector<float>;

// A tier all along.
struct Run {
  std::vector<Surface> surfaces;               // [ticks]
  std::vector<std::vector<std::byte>> states;  // every kApart
};

Run run_in(const demo::CharacterFile& character, const Way& way) {
  Player player(character);
  Run run;
  const auto ticks = static_cast<size_t>(kSeconds / player.asset().tick_s);
  for (size_t tick = 0; tick < ticks; ++tick) {
    player.step(way);
    run.surfaces.push_back(player.surface());
    if (tick % kApart == kApart - 1) run.states.push_back(player.save());
  }
  return run;
}

double distance(const Surface& a, const Surface& b, size_t v) {
  return std::hypot(double{a[v]} - double{b[v]}, double{a[v + 1]} - double{b[v + 1]},
                    double{a[v + 2]} - double{b[v + 2]});
}

struct Jump {
  double at_once_m = 0, beyond_m = 0;
};

// The longest of a vertex's last three steps.
double own_step(const Run& run, size_t t, size_t v) {
  double longest = 0;
  for (size_t back = 0; back < 3; ++back)
    longest = std::max(longest, distance(run.surfaces[t - back], run.surfaces[t - back - 1], v));
  return longest;
}

void follow_change(Player& player, const Run& from, const Run& to, const Way& way, size_t change,
                   Jump* jump) {
  const size_t first = (change + 1) * kApart, last = std::min(first + kWatched, from.surfaces.size());
  player.restore(from.states[change], first);
  Surface before = from.surfaces[first - 1];
  for (size_t t = first; t < last; ++t) {
    player.step(way);
    const Surface now = player.surface(), &stays = from.surfaces[t];
    for (size_t v = 0; v < now.size(); v += 3) {
      if (t == first) jump->at_once_m = std::max(jump->at_once_m, distance(now, stays, v));
      const double own = std::max(own_step(from, t, v), own_step(to, t, v));
      jump->beyond_m = std::max(jump->beyond_m, distance(now, before, v) - own);
    }
    before = now;
  }
}

// What the scheduler may choose: the points of the front, and to be left alone. With `rates` also what it
// does not buy, modes in every second tick.
std::vector<Way> ways_of(const world::Asset& asset, bool rates) {
  std::vector<Way> ways = {{Tier::kExtrapolate, 0, 1}};
  for (uint32_t l = 1; l < asset.front.count; ++l)
    ways.push_back({asset.front.levels[l].tier, asset.front.levels[l].graph, asset.front.levels[l].every});
  for (size_t w = ways.size(); rates && w-- > 1;)
    if (ways[w].tier == Tier::kModal) ways.push_back({Tier::kModal, ways[w].level, 2});

  return ways;
}

std::string name_of(const world::Asset& asset, const Way& way) {
  constexpr const char* kNames[] = {"skinning", "extrapolate", "network", "spring", "modal"};
  std::string name = kNames[static_cast<size_t>(way.tier)];
  if (way.every > 1) name += " every " + std::to_string(way.every);
  if (way.tier == Tier::kExtrapolate || asset.level_count == 1) return name;
  return name + " on " + std::to_string(asset.levels[way.level].pack.regions[0].node_count);
}

void run(const std::string& path, bool rates) {
  const demo::CharacterFile character = demo::open_character(path);
  Player player(character);
  const std::vector<Way> ways = ways_of(player.asset(), rates);
  std::vector<Run> runs;
  for (const Way& way : ways) runs.push_back(run_in(character, way));
  std::puts("from,to,at_once_mm,at_once_percent,beyond_both_mm,beyond_both_percent");
  for (size_t f = 1; f < ways.size(); ++f) {  // what is not simulated has faded before the next change
    for (size_t w = 0; w < ways.size(); ++w) {
      if (w == f) continue;
      Jump jump;
      for (size_t change = 0; change < runs[f].states.size(); ++change)
        follow_change(player, runs[f], runs[w], ways[w], change, &jump);
      const double percent = 100 / player.height_m();
      std::printf("%s,%s,%.3f,%.4f,%.3f,%.4f\n", name_of(player.asset(), ways[f]).c_str(),
                  name_of(player.asset(), ways[w]).c_str(), 1e3 * jump.at_once_m, percent * jump.at_once_m,
                  1e3 * jump.beyond_m, percent * jump.beyond_m);
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{
      "How far a change of tier moves a vertex at once, of all pairs that the scheduler may choose."};
  std::string path;
  app.add_option("pack", path, "C.sinew")->required();
  bool rates = false;
  app.add_flag("--rates", rates, "and of modes in every second tick, which it does not buy");
  CLI11_PARSE(app, count, arguments);
  try {
    run(path, rates);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "perf_jumps: %s\n", error.what());
    return 2;
  }
  return 0;
}
