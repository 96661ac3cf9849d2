// tick.cpp  An instance's share of a step: its ticks, then publishing.
#include "world/tick.hpp"

#include <algorithm>

#include "core/clock.hpp"
#include "core/flush_denormals.hpp"
#include "tissue/drive.hpp"
#include "tissue/guard.hpp"
#include "tissue/inputs.hpp"
#include "tissue/network.hpp"
#include "world/blend.hpp"
#include "world/motion.hpp"
#include "world/publish.hpp"

namespace sinew::world {
namespace {

void assemble_drive(Instance& instance) noexcept {
  const Asset& asset = *instance.asset;
  const size_t stride = tissue::input_stride(asset.network);
  for (size_t r = 0; r < asset.pack.regions.size(); ++r) {
    const pack::RegionRecord& region = asset.pack.regions[r];
    const size_t node = region.first_node, vector = 3 * node;
    float* drive = instance.drive + tissue::kDriveWidth * node;
    tissue::compute_drive(instance.motion[r], static_cast<float>(asset.tick_s), instance.places[0] + vector,
                          instance.places[1] + vector, instance.places[2] + vector, region.node_count, drive);
    instance.state->input_clamps +=
        tissue::assemble_inputs(asset.network,
                                {.region = &region,
                                 .nodes = asset.pack.nodes.data() + node,
                                 .drive = drive,
                                 .displacement = instance.simulated[0] + vector,
                                 .displacement_before = instance.simulated[1] + vector},
                                instance.inputs + stride * node);
  }
}

// False: a guard gave the state up.
bool run_network(Instance& instance) noexcept {
  const Asset& asset = *instance.asset;
  InstanceState& state = *instance.state;
  tissue::network_step(asset.network, asset.graph, instance.inputs, nullptr, instance.network_state,
                       instance.network_scratch);
  std::copy_n(instance.simulated[0], size_t{3} * asset.node_count(), instance.simulated[1]);
  const tissue::GuardResult guard = tissue::guard_step(asset.network, asset.pack.regions, asset.node_count(),
                                                       instance.network_state, instance.simulated[0]);
  state.displacement_clamps += guard.displacement_clamps;
  state.clamped_ticks = guard.displacement_clamps > 0 ? state.clamped_ticks + 1 : 0;
  return !guard.restart && state.clamped_ticks <= kMostClampedTicks;
}

void network_tick(Instance& instance, double time_s, const ClockHook& clock) noexcept {
  const uint64_t start_ns = core::now_ns(clock);
  follow_motion(instance, time_s);
  assemble_drive(instance);
  const uint64_t driven_ns = core::now_ns(clock);
  if (!run_network(instance)) restart(instance);
  instance.times.drive_ns += driven_ns - start_ns;
  instance.times.tissue_ns += core::now_ns(clock) - driven_ns;
}

void run_ticks(Instance& instance, const ClockHook& clock) noexcept {
  InstanceState& state = *instance.state;
  const frame::TickPlan& ticks = instance.plan.ticks;
  if (ticks.dropped_s > 0) state.motion_stale = 1;
  for (uint32_t k = 0; k < ticks.ticks; ++k) {
    const bool network = state.tier == Tier::kNetwork;
    if (network)
      network_tick(instance, ticks.first_tick_s + k * instance.asset->tick_s, clock);
    else
      state.motion_stale = 1;
    state.ticks_since_network = network ? 0 : state.ticks_since_network + 1;
    show_tick(instance);
    state.untouched = 0;
  }
  state.remainder_s = ticks.remainder_s;
  state.render_fraction = static_cast<float>(ticks.remainder_s / instance.asset->tick_s);
}

// The deadline counts only where the network would do something.
Tier tier_at(const Instance& instance, uint64_t now_ns, uint64_t deadline_ns) noexcept {
  const bool late = instance.plan.ticks.ticks > 0 && now_ns >= deadline_ns;
  return instance.plan.tier == Tier::kNetwork && late ? Tier::kExtrapolate : instance.plan.tier;
}

}  // namespace

void step_instance(Instance& instance, const TickContext& context) noexcept {
  const core::FlushDenormals flush;
  const uint64_t start_ns = core::now_ns(context.clock);
  const Tier tier = tier_at(instance, start_ns, context.deadline_ns);
  instance.times = {};
  instance.restarted = false;
  instance.cut = tier != instance.plan.tier;
  enter_tier(instance, tier);
  take_pose(instance, context.teleport_distance_m);
  run_ticks(instance, context.clock);
  keep_pose(instance);
  const uint64_t ticked_ns = core::now_ns(context.clock);
  publish(instance);
  const uint64_t end_ns = core::now_ns(context.clock);
  instance.times.publish_ns = end_ns - ticked_ns;
  instance.times.total_ns = end_ns - start_ns;
}

}  // namespace sinew::world
