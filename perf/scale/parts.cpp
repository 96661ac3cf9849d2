// parts.cpp  Where a tick of one character goes.
//
// Each part is called as character/tissue/simulate.cpp and character/tick.cpp call it, on an instance in the
// middle of its clips. A part that goes on from its own answer settles; what it costs does not depend on
// that.
#include <cstring>

#include "baker/common/lone_instance.hpp"
#include "character/output/publish.hpp"
#include "character/tissue/drive_nodes.hpp"
#include "character/tissue/simulate.hpp"
#include "character/transition/blend.hpp"
#include "core/floating_point.hpp"
#include "perf/kernels/fma_peak.hpp"
#include "perf/scale/crowd.hpp"
#include "perf/scale/groups.hpp"
#include "perf/scale/operations.hpp"
#include "perf/scale/record.hpp"
#include "perf/scale/stopwatch.hpp"
#include "tissue/frames/node_bend.hpp"
#include "tissue/network/inputs.hpp"
#include "tissue/network/network.hpp"

namespace sinew::perf {
namespace {

constexpr int kWarmFrames = 90;
constexpr double kTick_s = 1.0 / 60;

// An instance outside a world, so that its parts can be called one by one.
class Subject {
 public:
  explicit Subject(const demo::CharacterFile& character)
      : lone_(character.file.bytes()), motion_(demo::make_motion(character, "")) {
    for (int frame = 0; frame < kWarmFrames; ++frame) pose(), step();
  }

  void pose() { motion_->pose_at(kTick_s * ++frame_, lone_.joints(), &lone_.root()); }
  void step() { lone_.step({.tier = asset_.best()}); }

  void pose_nodes() {
    const pack::PackView& pack = asset_.pack;
    world::skin_matrices(pack.joints, instance_.motion.joints, instance_.motion.skin);
    tissue::pose_nodes(pack.nodes, instance_.motion.skin, instance_.state->motion.root.rotation_xyzw,
                       instance_.motion.poses[0]);
  }
  void share_bend() {
    for (const pack::RegionRecord& region : asset_.pack.regions)
      tissue::share_bend(region.anchor_node, region.node_count,
                         instance_.motion.poses[0] + region.first_node);
  }
  void keep_poses() {
    const size_t bytes = sizeof(tissue::NodePose) * asset_.node_count();
    for (int back = 2; back > 0; --back)
      std::memcpy(instance_.motion.poses[back], instance_.motion.poses[back - 1], bytes);
  }
  void drive() { world::drive_nodes(instance_); }
  void simulate(Tier tier) {
    instance_.state->tier = tier;
    world::simulate_tick(instance_);
  }
  void network() {
    tissue::network_step(asset_.network, asset_.levels[0].graph, instance_.tissue.inputs,
                         instance_.tissue.carry, instance_.tissue.network_memory,
                         instance_.tissue.network_scratch);
  }
  void show() { world::show_tick(instance_); }
  // A node of each region a little elsewhere each time, for what has not changed is not carried again.
  void publish() {
    nudge_m_ = -nudge_m_;
    for (const pack::RegionRecord& region : asset_.pack.regions)
      instance_.transition.shown[0][size_t{3} * region.first_node] += nudge_m_;
    world::publish(instance_);
  }

 private:
  baker::LoneInstance lone_;
  const world::Asset& asset_ = lone_.asset();
  world::Instance& instance_ = lone_.instance();
  std::unique_ptr<demo::Motion> motion_;
  int frame_ = 0;
  float nudge_m_ = 1e-4f;
};

struct Part {
  const char* name;
  double us, mflop;
};

void put_part(const Case& of, const Part& part, double peak_gflops) {
  Case row = of;
  row.subject = part.name;
  put(row, "us", part.us);
  if (part.mflop == 0) return;
  put(row, "mega_operations", part.mflop);
  put(row, "share_of_peak", part.mflop / part.us * 1e3 / peak_gflops);
}

}  // namespace

void measure_parts(const demo::CharacterFile& character, int rounds) {
  const core::FloatingPointScope mode;
  Subject subject(character), whole(character);
  Crowd crowd(character, 1);
  crowd.pose();
  crowd.step();
  const pack::PackView& pack = character.view;
  float sink = 0;
  double peak_operations = 0;
  constexpr int kRepeats = 20;
  std::vector<Lap> laps;
  const auto lap = [&](const char* name, int repeats, std::function<void()> work) {
    laps.push_back({name, repeats, std::move(work)});
  };
  lap("peak", 1, [&] { peak_operations = run_fma(100'000, &sink); });
  lap("clip", kRepeats, [&] { whole.pose(); });
  lap("clip and tick", kRepeats, [&] { whole.pose(), whole.step(); });
  lap("history", kRepeats, [&] { subject.keep_poses(); });
  lap("poses", kRepeats, [&] { subject.pose_nodes(); });
  lap("poses and bend", kRepeats, [&] { subject.pose_nodes(), subject.share_bend(); });
  lap("drive", kRepeats, [&] { subject.drive(); });
  lap("network tick", kRepeats, [&] { subject.simulate(Tier::kNetwork); });
  lap("network step", kRepeats, [&] { subject.network(); });
  lap("modal tick", kRepeats, [&] { subject.simulate(Tier::kModal); });
  lap("show", kRepeats, [&] { subject.show(); });
  lap("publish", kRepeats, [&] { subject.publish(); });
  lap("deltas", kRepeats, [&] { crowd.read(0, Space::kBind); });
  lap("positions", kRepeats, [&] { crowd.read(0, Space::kCharacter); });
  lap("normals", kRepeats, [&] { crowd.read_normals(0); });
  run_laps(laps, rounds);

  const auto us = [&](const char* name) { return median(lap_named(laps, name).cpu_us); };
  const double peak = peak_operations / us("peak") * 1e-3;  // GFLOP/s
  const double tick = us("clip and tick") - us("clip");
  const Part parts[] = {
      {"node history", us("history"), 0},
      {"node poses", us("poses"), 0},
      {"bend", us("poses and bend") - us("poses"), 0},
      {"drive", us("drive"), 0},
      {"modal base", us("modal tick"), modal_mflop(pack, false)},
      {"network step", us("network step"), network_mflop(pack)},
      {"inputs; closing on the base; guards", us("network tick") - us("modal tick") - us("network step"), 0},
      {"show", us("show"), 0},
      {"embedding; skin matrices", us("publish"), carry_mflop(pack)},
      {"whole tick", tick, character_mflop(pack)},
      {"read: bind-space deltas", us("deltas"), 0},
      {"read: positions", us("positions"), 0},
      {"read: normals", us("normals"), 0},
  };
  const Case of{.group = "parts",
                .subject = "peak",
                .vertices = pack.character->vertex_count,
                .instances = 1,
                .workers = 1};
  put(of, "gflop_a_second", peak);
  for (const Part& part : parts) put_part(of, part, peak);
}

}  // namespace sinew::perf
