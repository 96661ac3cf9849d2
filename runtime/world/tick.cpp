// tick.cpp  An instance's share of a step: its ticks, then publishing.
#include "world/tick.hpp"

#include "core/clock.hpp"
#include "core/flush_denormals.hpp"
#include "frame/scheduler.hpp"
#include "world/blend.hpp"
#include "world/hidden.hpp"
#include "world/motion.hpp"
#include "world/publish.hpp"
#include "world/push_surface.hpp"
#include "world/rod_motion.hpp"
#include "world/simulate.hpp"
#include "world/sleep.hpp"
#include "world/tissue_contacts.hpp"
#include "world/update_rate.hpp"

namespace sinew::world {
namespace {

// Between ticks that are simulated whole.
void carried_tick(Instance& instance, const ClockHook& clock) noexcept {
  const uint64_t start_ns = core::now_ns(clock);
  if (!simulate_tick(instance)) restart(instance);
  ++instance.state->since_ticks;
  instance.times.tissue_ns += core::now_ns(clock) - start_ns;
}

void simulated_tick(Instance& instance, double time_s, const TickContext& context) noexcept {
  const ClockHook& clock = context.clock;
  if (!begin_tick(instance)) return carried_tick(instance, clock);
  const uint64_t start_ns = core::now_ns(clock);
  follow_motion(instance, time_s);
  respace_past(instance);
  drive_nodes(instance);
  const uint64_t driven_ns = core::now_ns(clock);
  watch_drive(instance, context.sleep_tolerance);
  if (simulate_tick(instance))
    touch_tissue(instance);
  else
    restart(instance);
  watch_motion(instance, context.sleep_tolerance);
  instance.state->since_ticks = 1;
  const uint64_t soft_ns = core::now_ns(clock);
  if (frame::is_simulated(instance.state->tier)) simulate_rods(instance, context.sleep_tolerance);
  instance.times.drive_ns += driven_ns - start_ns;
  instance.times.tissue_ns += soft_ns - driven_ns;
  instance.times.rods_ns += core::now_ns(clock) - soft_ns;
}

void run_ticks(Instance& instance, const TickContext& context) noexcept {
  InstanceState& state = *instance.state;
  const frame::TickPlan& ticks = instance.plan.ticks;
  if (ticks.dropped_s > 0) state.motion_stale = 1;
  for (uint32_t k = 0; k < ticks.ticks; ++k) {
    state.fallback_ticks -= state.fallback_ticks > 0;
    instance.told = {};
    if (frame::is_simulated(state.tier))
      simulated_tick(instance, ticks.first_tick_s + k * instance.asset->tick_s, context);
    else
      state.motion_stale = 1, instance.heard_now = false;
    state.ticks_since_network = state.tier == Tier::kNetwork ? 0 : state.ticks_since_network + 1;
    show_tick(instance);
    push_surface(instance);
    state.untouched = 0;
    ++state.ticks;
  }
  state.remainder_s = ticks.remainder_s;
  state.render_fraction = static_cast<float>(ticks.remainder_s / instance.asset->tick_s);
}

// The deadline counts only where something would be simulated.
Tier tier_at(const Instance& instance, uint64_t now_ns, uint64_t deadline_ns) noexcept {
  const bool late = instance.plan.ticks.ticks > 0 && now_ns >= deadline_ns;
  return frame::is_simulated(instance.plan.tier) && late ? Tier::kExtrapolate : instance.plan.tier;
}

}  // namespace

void step_instance(Instance& instance, const TickContext& context) noexcept {
  const core::FlushDenormals flush;
  const uint64_t start_ns = core::now_ns(context.clock);
  const Tier tier = tier_at(instance, start_ns, context.deadline_ns);
  instance.times = {};
  instance.came_back = instance.state->hidden != 0;
  if (instance.came_back) come_back(instance);
  instance.restarted = instance.fell_back = false;
  instance.cut = tier != instance.plan.tier;
  enter_tier(instance, tier);
  take_pose(instance, context.teleport_distance_m);
  run_ticks(instance, context);
  keep_pose(instance);
  const uint64_t ticked_ns = core::now_ns(context.clock);
  publish(instance);
  const uint64_t end_ns = core::now_ns(context.clock);
  instance.times.publish_ns = end_ns - ticked_ns;
  instance.times.total_ns = end_ns - start_ns;
}

}  // namespace sinew::world
