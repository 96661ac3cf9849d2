// cases.cpp  see cases.hpp.
#include "perf/trade/cases.hpp"

#include <cmath>
#include <cstdio>

#include "tests/rods/rod_scenes.hpp"
#include "tests/scenes/branching_rod.hpp"

namespace sinew::perf {
namespace {

// The rod of ROD_FACTS, falling from the horizontal.
Segments chain(uint32_t segments, double young_pa) {
  return test::straight_rod({.segments = segments, .young_pa = static_cast<float>(young_pa)});
}

Segments helix(uint32_t segments, double young_pa) {
  return test::helix(segments, 0.02, static_cast<float>(young_pa));
}

// Hangs: its root is above.
Segments tree(uint32_t segments, double young_pa) { return test::forked_rod(segments, young_pa, -1); }

// Down over a capsule across its way, 1.2 m from its root, onto a floor 0.6 m below; there it stays.
Status over_capsule_onto_floor(rods::RodCollider& collider) {
  const rods::Capsule capsule = {
      .ends_m = {{1.2, -0.25, -2}, {1.2, -0.25, 2}}, .radius_m = 0.15f, .friction = 0.3f};
  const rods::Plane floor = {.point_m = {0, -0.6, 0}, .friction = 0.3f};
  const Status status = collider.set_capsules({&capsule, 1});
  return status.ok() ? collider.set_planes({&floor, 1}) : status;
}

Status nothing(rods::RodCollider&) { return {}; }
void stay(rods::RodBatch&, int) {}

// The root goes to and fro, 3 cm at 1.5 Hz.
void shake(rods::RodBatch& batch, int step) {
  const auto place = [](int k) { return 0.03 * std::sin(2 * M_PI * 1.5 * k / 60); };
  for (uint32_t s = 0; s < batch.strand_count(); ++s) {
    rods::SegmentPose target = batch.pose(s, 0);
    target.position_m[0] += place(step + 1) - place(step);
    (void)batch.set_target(s, 0, target);
  }
}

constexpr TradeScene kScenes[] = {
    {"chain", false, false, 0.02f, chain, nothing, stay},
    {"helix", false, false, 1.0f / 60, helix, nothing, shake},
    {"tree", true, false, 1.0f / 60, tree, nothing, shake},
    {"collisions", false, true, 1.0f / 60, chain, over_capsule_onto_floor, stay}};

constexpr TradeSolver kSolvers[] = {{"direct", baker::SolverKind::kDirect, true, 40, false},
                                    {"cg", baker::SolverKind::kCg, true, 6, true},
                                    {"local", baker::SolverKind::kLocal, false, 120, true}};

constexpr TradeStart kStarts[] = {{"zero", rods::RodStart::kZero},
                                  {"previous", rods::RodStart::kPrevious},
                                  {"continued", rods::RodStart::kContinued}};

constexpr uint32_t kSegments[] = {10, 30, 50, 100, 200};
constexpr double kYoung_pa[] = {1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
constexpr uint32_t kBatch = 16, kLongestInBatch = 50;  // strands of a batch, and what is measured in one
constexpr uint32_t kLongestInContact = 100;

}  // namespace

std::span<const TradeScene> trade_scenes() { return kScenes; }
std::span<const TradeSolver> trade_solvers() { return kSolvers; }
std::span<const TradeStart> trade_starts() { return kStarts; }

std::string key_of(const TradeCase& c) {
  char text[128];
  std::snprintf(text, sizeof text, "%s,%u,%u,%.0e,%s,%s", c.scene->name, c.strands, c.segments, c.young_pa,
                c.solver->name, c.start->name);
  return text;
}

std::vector<TradeCase> trade_cases(std::span<const TradeStart> starts, bool quick) {
  std::vector<TradeCase> out;
  for (const TradeScene& scene : kScenes) {
    for (const uint32_t segments : kSegments) {
      for (const double young : kYoung_pa) {
        for (const uint32_t strands : {1u, kBatch}) {
          if (strands > 1 && segments > kLongestInBatch) continue;
          if (scene.contacts && segments > kLongestInContact) continue;
          if (quick && (segments != 10 || (young != 1e4 && young != 1e8) || strands > 1)) continue;
          for (const TradeSolver& solver : kSolvers) {
            if (scene.contacts && !solver.contacts) continue;
            for (const TradeStart& start : starts) {
              out.push_back({&scene, strands, segments, young, &solver, &start});
            }
          }
        }
      }
    }
  }
  return out;
}

}  // namespace sinew::perf
