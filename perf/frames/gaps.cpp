// gaps.cpp  perf_gaps: what a gap in simulation leaves behind; CSV to stdout.
//
// Along recorded truths (sinew-bake truth --positions) an instance in one tier is left alone for some ticks,
// every seven ticks anew, and then simulated again. Told is what it is off the truth, as a share of what
// skinning is off in the same ticks: in the gap, in the ticks after it, and without any gap; and
//   beyond both  how much further a vertex moves, from one frame to the next, than it did without the gap in
//                that frame and the two before it, in per cent of the height; bind space, as of perf_jumps
#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "baker/common/lone_instance.hpp"
#include "perf/frames/level_name.hpp"
#include "samples/demo/trajectory.hpp"

namespace {

using namespace sinew;

constexpr uint32_t kApart = 7, kSettled = 2 * kApart;  // ticks
constexpr uint32_t kGaps[] = {1, 2, 3, 8, 40};
constexpr std::array<uint32_t, 3> kEnds = {4, 12, 40};  // of what is told after a gap
using Shares = std::array<double, 1 + kEnds.size()>;

using Way = baker::LoneInstance::Plan;

// Of a tick.
struct Seen {
  double error_mm;
  std::vector<float> displacement;  // [vertices][3], bind space
};

class Player {
 public:
  Player(const demo::CharacterFile& character, const demo::Trajectory& truth)
      : truth_(truth), lone_(character.file.bytes()), true_(asset().vertex_count()) {}
  Seen step(const Way& way) {
    const double time_s = ++tick_ / truth_.rate_hz();
    truth_.pose_at(time_s, lone_.joints(), &lone_.root());
    lone_.step(way);
    return {error_mm(time_s), lone_.positions(Space::kBind)};
  }
  std::vector<std::byte> save() const { return lone_.save(); }
  void restore(const std::vector<std::byte>& state, uint32_t tick) {
    lone_.restore(state);
    tick_ = tick;
  }
  const world::Asset& asset() const { return lone_.asset(); }
  uint32_t ticks() const { return static_cast<uint32_t>(std::lround(truth_.seconds() * truth_.rate_hz())); }

 private:
  double error_mm(double time_s) {
    const std::vector<float> shown = lone_.positions();
    truth_.positions_at(time_s, true_);
    double sum_m = 0;
    for (const uint32_t v : asset().pack.region_vertices)
      sum_m +=
          static_cast<double>((Eigen::Map<const Eigen::Vector3f>(&shown[size_t{3} * v]) - true_[v]).norm());
    return 1e3 * sum_m / static_cast<double>(asset().pack.region_vertices.size());
  }

  const demo::Trajectory& truth_;
  baker::LoneInstance lone_;
  std::vector<Eigen::Vector3f> true_;
  uint32_t tick_ = 0;
};

// Without a gap; seen[t] is of tick t + 1.
struct Run {
  std::vector<Seen> seen;
  std::vector<std::vector<std::byte>> states;  // of every kApart-th tick
};

Run run_in(const demo::CharacterFile& character, const demo::Trajectory& truth, const Way& way) {
  Player player(character, truth);
  Run run;
  for (uint32_t t = 1; t <= player.ticks(); ++t) {
    run.seen.push_back(player.step(way));
    if (t % kApart == 0) run.states.push_back(player.save());
  }
  return run;
}

double moved(const std::vector<float>& a, const std::vector<float>& b, size_t v) {
  return std::hypot(double{a[v]} - double{b[v]}, double{a[v + 1]} - double{b[v + 1]},
                    double{a[v + 2]} - double{b[v + 2]});
}

double beyond_m(const std::vector<float>& now, const std::vector<float>& before, const Run& steady,
                size_t t) {
  double most = 0;
  for (size_t v = 0; v < now.size(); v += 3) {
    double own = 0;
    for (size_t back = 0; back < 3; ++back)
      own =
          std::max(own, moved(steady.seen[t - back].displacement, steady.seen[t - back - 1].displacement, v));
    most = std::max(most, moved(now, before, v) - own);
  }
  return most;
}

struct Left {
  Shares error_mm{}, steady_mm{}, skinning_mm{};  // in the gap, then by kEnds
  double beyond_m = 0;
};

// After that tick, from its state without a gap.
void follow(Player& player, const Run& steady, const Run& skinned, const Way& way, uint32_t tick,
            uint32_t gap, Left* left) {
  player.restore(steady.states[tick / kApart - 1], tick);
  const std::vector<float>* before = &steady.seen[tick - 1].displacement;
  Seen seen;
  for (uint32_t k = 0; k < gap + kEnds.back(); ++k) {
    Seen now = player.step(k < gap ? Way{Tier::kExtrapolate, way.level} : way);
    const size_t told =
        k < gap ? 0 : 1 + static_cast<size_t>(std::ranges::upper_bound(kEnds, k - gap) - kEnds.begin());
    left->error_mm[told] += now.error_mm;
    left->steady_mm[told] += steady.seen[tick + k].error_mm;
    left->skinning_mm[told] += skinned.seen[tick + k].error_mm;
    left->beyond_m = std::max(left->beyond_m, beyond_m(now.displacement, *before, steady, tick + k));
    seen = std::move(now);
    before = &seen.displacement;
  }
}

void tell(const std::string& motion, const std::string& tier, uint32_t gap, const Left& left,
          double height_m) {
  std::printf("%s,%s,%u", motion.c_str(), tier.c_str(), gap);
  double steady_mm = 0, skinning_mm = 0;
  for (size_t i = 0; i < left.error_mm.size(); ++i) {
    std::printf(",%.4f", left.error_mm[i] / left.skinning_mm[i]);
    steady_mm += left.steady_mm[i];
    skinning_mm += left.skinning_mm[i];
  }
  std::printf(",%.4f,%.3f\n", steady_mm / skinning_mm, 100 * left.beyond_m / height_m);
}

// The best there is, and the cheapest modes.
std::vector<std::pair<std::string, Way>> ways_of(const world::Asset& asset) {
  const uint32_t coarsest = asset.level_count - 1;
  const auto nodes = [&](uint32_t level) { return perf::level_name(asset.levels[level]); };
  std::vector<std::pair<std::string, Way>> ways = {{"modal on " + nodes(coarsest), {Tier::kModal, coarsest}}};
  if (pack::affords_network(asset.pack)) ways.push_back({"network on " + nodes(0), {Tier::kNetwork, 0}});
  return ways;
}

void measure(const demo::CharacterFile& character, const demo::Trajectory& truth) {
  Player player(character, truth);
  const Run skinned = run_in(character, truth, {Tier::kSkinning, 0});
  for (const auto& [name, way] : ways_of(player.asset())) {
    const Run steady = run_in(character, truth, way);
    for (const uint32_t gap : kGaps) {
      Left left;
      for (uint32_t tick = kSettled; tick + gap + kEnds.back() <= player.ticks(); tick += kApart)
        follow(player, steady, skinned, way, tick, gap, &left);
      tell(truth.name_at(0), name, gap, left, static_cast<double>(player.asset().pack.character->height_m));
    }
  }
}

void refuse_short(const std::string& path, const demo::Trajectory& truth) {
  constexpr uint32_t kLeast = kSettled + kGaps[std::size(kGaps) - 1] + kEnds.back();
  if (std::lround(truth.seconds() * truth.rate_hz()) < kLeast)
    throw std::runtime_error(path + ": too short for the longest gap; record " + std::to_string(kLeast) +
                             " ticks or more");
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{"What a gap in simulation leaves behind, against recorded truth."};
  std::string path;
  std::vector<std::string> truths;
  app.add_option("pack", path, "C.sinew")->required();
  app.add_option("truth", truths, "trajectories of sinew-bake truth --positions")->required();
  CLI11_PARSE(app, count, arguments);
  try {
    const demo::CharacterFile character = demo::open_character(path);
    std::vector<demo::Trajectory> motions;
    for (const std::string& truth : truths) {
      motions.emplace_back(truth, character);
      refuse_short(truth, motions.back());
    }
    std::puts("motion,tier,gap_ticks,in_gap,to_4,to_12,to_40,without_gap,beyond_both_percent");
    for (const demo::Trajectory& motion : motions) measure(character, motion);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "perf_gaps: %s\n", error.what());
    return 2;
  }
  return 0;
}
