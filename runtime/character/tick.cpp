// tick.cpp  An instance's share of a step: its ticks, then publishing.
#include "character/tick.hpp"

#include <algorithm>

#include "character/asset/affords_surface.hpp"
#include "character/contacts/push_surface.hpp"
#include "character/contacts/tissue_contacts.hpp"
#include "character/motion/excitation.hpp"
#include "character/motion/motion.hpp"
#include "character/motion/pose_bound.hpp"
#include "character/motion/teleport.hpp"
#include "character/output/between_ticks.hpp"
#include "character/output/events.hpp"
#include "character/output/publish.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/parameters/tuning.hpp"
#include "character/rest/asleep.hpp"
#include "character/rest/dormant.hpp"
#include "character/rest/hidden.hpp"
#include "character/rest/sleep.hpp"
#include "character/rods/rod_motion.hpp"
#include "character/tier_limit.hpp"
#include "character/tissue/drive_nodes.hpp"
#include "character/tissue/simulate.hpp"
#include "character/transition/blend.hpp"
#include "character/transition/catch_up.hpp"
#include "character/transition/change_level.hpp"
#include "core/clock.hpp"
#include "core/floating_point.hpp"
#include "core/marker.hpp"

namespace sinew::world {
namespace {

void simulated_tick(Instance& instance, double time_s, const TickContext& context, uint32_t slot) noexcept {
  const ClockHook& clock = context.clock;
  const bool goes_on = !instance.state->poses.motion_stale && !instance.marks.changed_level &&
                       instance.plan.ticks.ticks == 1 && instance.marks.made_up == 0;
  const uint64_t start_ns = core::now_ns(clock);
  Marker driving(context.profiler, "drive", slot);
  follow_motion(instance, time_s);
  drive_nodes(instance);
  driving.end();
  const uint64_t driven_ns = core::now_ns(clock);
  Marker tissue(context.profiler, "tissue", slot);
  watch_drive(instance);
  if (simulate_tick(instance)) {
    touch_tissue(instance);
    hold_added(instance, goes_on);
  } else {
    restart(instance);
  }
  watch_motion(instance);
  tissue.end();
  const uint64_t soft_ns = core::now_ns(clock);
  Marker rods(context.profiler, "rods", slot);
  if (frame::is_simulated(instance.state->tier)) simulate_rods(instance);
  rods.end();
  forget_carried(instance);
  instance.times.drive_ns += driven_ns - start_ns;
  instance.times.tissue_ns += soft_ns - driven_ns;
  instance.times.rods_ns += core::now_ns(clock) - soft_ns;
}

void simulate_missed(Instance& instance, const TickContext& context, uint32_t slot) noexcept {
  InstanceState& state = *instance.state;
  for (uint32_t left = state.transition.missed_ticks; left > 0 && frame::is_simulated(state.tier); --left) {
    simulated_tick(instance, instance.plan.ticks.first_tick_s - left * instance.asset->tick_s, context, slot);
    instance.contacts.touch_count = 0;
  }
  if (frame::is_simulated(state.tier)) ride_on(instance);
}

void push_out(Instance& instance, const TickContext& context, uint32_t slot) noexcept {
  if (!instance.contacts.pushes) return;
  const uint64_t start_ns = core::now_ns(context.clock);
  const Marker tissue(context.profiler, "tissue", slot);
  push_surface(instance);
  instance.times.tissue_ns += core::now_ns(context.clock) - start_ns;
}

void run_ticks(Instance& instance, const TickContext& context, uint32_t slot) noexcept {
  InstanceState& state = *instance.state;
  const frame::TickPlan& ticks = instance.plan.ticks;
  if (ticks.dropped_s > 0) {
    if (!state.poses.motion_stale) carry_rods(instance);
    state.poses.motion_stale = 1;
  }
  if (frame::is_simulated(state.tier) && state.transition.missed_ticks > 0)
    simulate_missed(instance, context, slot);
  for (uint32_t k = 0; k < ticks.ticks; ++k) {
    state.fallback_ticks -= state.fallback_ticks > 0;
    instance.told = {};
    const bool tuned = state.parameters.tuned && frame::is_simulated(state.tier);
    if (tuned) begin_tuned_tick(instance);
    if (frame::is_simulated(state.tier))
      simulated_tick(instance, ticks.first_tick_s + k * instance.asset->tick_s, context, slot);
    else
      miss_tick(instance);
    state.tissue.ticks_since_network =
        state.tier == Tier::kNetwork ? 0 : state.tissue.ticks_since_network + 1;
    show_tick(instance);
    push_out(instance, context, slot);
    if (tuned) end_tuned_tick(instance);
    state.tissue.untouched = 0;
  }
  state.remainder_s = ticks.remainder_s;
  state.poses.render_fraction = frame::passed_share(ticks, instance.asset->tick_s);
}

// ---- the deadline ----

bool changes_level(const Instance& instance) noexcept {
  return frame::is_simulated(instance.plan.decision.tier) && instance.plan.ticks.ticks > 0 &&
         instance.plan.decision.level != instance.state->level;
}
bool refines(const Instance& instance) noexcept {
  return changes_level(instance) && instance.plan.decision.level < instance.state->level;
}

bool ends_between(const Instance& instance) noexcept {
  return frame::passed_share(instance.plan.ticks, instance.asset->tick_s) > 0;
}

// By what one of twenty takes; where that is much of the step, and nobody behind it makes up for what it is
// late by, by what one of a hundred does.
float most_us(const Instance& instance, const TickContext& context) noexcept {
  constexpr float kMuch = 0.04f;
  const frame::CostModel& cost = costs_of(instance).cost;
  const frame::CostEstimate& tick = cost.of(instance.plan.decision.tier, instance.plan.decision.level);
  const bool goes_on = catches_up(instance);
  const uint32_t missed = goes_on ? instance.state->transition.missed_ticks : 0u;
  const float between = ends_between(instance) ? cost.between(instance.plan.decision.tier).p95_us() : 0;
  const float ticks =
      (static_cast<float>(instance.plan.ticks.ticks + missed) + between) * instance.cost_factor;
  const bool enters = !frame::is_simulated(instance.state->tier) && !goes_on;
  const bool much = ticks * tick.estimate_us() > kMuch * context.tasks_us;
  return cost.publish.p95_us() + ticks * (much ? tick.p99_us() : tick.p95_us()) +
         (enters              ? cost.enter.p95_us()
          : refines(instance) ? cost.change.p95_us()
                              : 0);
}

// The next cheaper one that it may fall to at once.
Tier below(Tier tier) noexcept { return tier == Tier::kNetwork ? Tier::kModal : Tier::kExtrapolate; }

// Nothing of it is known that says it will be late.
bool is_in_time(const Instance& instance, const TickContext& context, double left_us) noexcept {
  const InstancePlan& plan = instance.plan;
  if (plan.ticks.ticks == 0 || !frame::is_simulated(plan.decision.tier)) return true;
  return costs_of(instance).cost.of(plan.decision.tier, plan.decision.level).is_known() &&
         static_cast<double>(most_us(instance, context)) <= left_us;
}

// Decides between the plan and what there is time for.
void meet_deadline(Instance& instance, const TickContext& context, uint64_t now_ns) noexcept {
  InstancePlan& plan = instance.plan;
  instance.marks.cut = instance.marks.held = false;
  if (context.deadline_ns == UINT64_MAX) return;
  const double left_us = (static_cast<double>(context.deadline_ns) - static_cast<double>(now_ns)) * 1e-3 -
                         static_cast<double>(plan.decision.behind_us * context.behind_scale);
  const Tier planned = plan.decision.tier;
  const uint32_t level = plan.decision.level;
  if (!is_in_time(instance, context, left_us))
    plan.decision.level = std::max(level, instance.state->level);  // no finer one now
  while (!is_in_time(instance, context, left_us)) plan.decision.tier = below(plan.decision.tier);
  instance.marks.cut = plan.decision.tier != planned || plan.decision.level != level;
  const bool simulates = frame::is_simulated(plan.decision.tier), stays = !simulates || plan.ticks.ticks == 0;
  const float shown_us =
      stays && simulates ? most_us(instance, context) : costs_of(instance).cost.publish.p95_us();
  instance.marks.held = stays && static_cast<double>(shown_us) > left_us && instance.marks.displaced;
}

void age(Instance& instance, bool rose, double frame_s) noexcept {
  InstanceState& state = *instance.state;
  const auto dt_s = static_cast<float>(frame_s);
  state.waited_s = waited_after(state, dt_s);
  state.held_s = rose ? 0 : state.held_s + dt_s;
  state.turn_left_s = std::max(0.0f, state.turn_left_s - dt_s);
}

// In rising quality.
uint32_t quality(Tier tier) noexcept {
  constexpr uint32_t kQuality[kTierCount] = {0, 0, 2, 0, 1};
  return kQuality[static_cast<size_t>(tier)];
}

// To a better tier, or a finer level of the same.
bool rises(const Instance& instance) noexcept {
  const uint32_t planned = quality(instance.plan.decision.tier), has = quality(instance.state->tier);
  return planned > has || (planned == has && instance.plan.decision.level < instance.state->level);
}

// Skin or capsules, between two simulated tiers: who begins anew wakes in any case.
bool changes_what_rods_touch(const Instance& instance, Tier had) noexcept {
  const InstancePlan& plan = instance.plan;
  if (!instance.contacts.def.surface || !frame::is_simulated(had) || !frame::is_simulated(plan.decision.tier))
    return false;
  const uint32_t level = plan.ticks.ticks > 0 ? plan.decision.level : instance.state->level;
  return affords_surface(had, instance.state->level) != affords_surface(plan.decision.tier, level);
}

}  // namespace

void step_instance(Instance& instance, const TickContext& context, uint32_t slot) noexcept {
  const core::FloatingPointScope mode;
  const Marker marker(context.profiler, "instance", slot);
  const uint64_t start_ns = core::now_ns(context.clock);
  const EventCounts counts = event_counts(instance);
  const bool waits = catch_up_first(instance);
  meet_deadline(instance, context, start_ns);
  const Tier tier = instance.plan.decision.tier;
  const bool rose = !waits && rises(instance);
  instance.times = {};
  wake(instance);
  const bool was_tuned = tunes_parts(instance);
  instance.marks.came_back = instance.state->hidden != 0;
  if (instance.marks.came_back) come_back(instance);
  instance.marks.restarted = instance.marks.fell_back = false;
  const bool goes_on = catches_up(instance);
  instance.marks.entered = frame::is_simulated(tier) && !goes_on &&
                           (!frame::is_simulated(instance.state->tier) || instance.state->poses.motion_stale);
  const Tier had = goes_on ? instance.state->left_tier : instance.state->tier;
  if (changes_what_rods_touch(instance, had)) wake_rods(instance);
  instance.marks.changed_level = changes_level(instance);
  instance.marks.refined = refines(instance);
  if (instance.marks.changed_level) {
    change_level(instance, instance.plan.decision.level);
    if (tunes_parts(instance)) retune_all(instance);
  }
  end_gap(instance, goes_on);
  enter_tier(instance, tier);
  take_pose(instance, context.teleport);
  watch_pose(instance);
  run_ticks(instance, context, slot);
  keep_pose(instance);
  age(instance, rose, context.frame_s);
  if (instance.plan.ticks.ticks > 0) follow_excitation(instance);
  fall_dormant(instance);
  if (was_tuned || tunes_parts(instance)) bound_pose(instance);  // how far parts may reach glides
  const uint64_t ticked_ns = core::now_ns(context.clock);
  if (!instance.marks.held) {
    const Marker publishing(context.profiler, "publish", slot);
    publish(instance, context.clock);
  } else {
    publish_pose(instance);
  }
  instance.marks.events = events_since(counts, instance);
  const uint64_t end_ns = core::now_ns(context.clock);
  instance.times.publish_ns = end_ns - ticked_ns;
  instance.times.total_ns = end_ns - start_ns;
}

void step_idle(Instance& instance, const TickContext& context) noexcept {
  InstanceState& state = *instance.state;
  const frame::TickPlan& ticks = instance.plan.ticks;
  instance.times = {};
  instance.marks.cut = instance.marks.held = instance.marks.restarted = instance.marks.fell_back =
      instance.marks.came_back = false;
  wake(instance);
  if (ticks.ticks > 0) {
    instance.told = {};
    state.poses.motion_stale = 1;
    state.tissue.untouched = 0;
  }
  state.tier = instance.plan.decision.tier;
  state.fallback_ticks -= std::min(state.fallback_ticks, ticks.ticks);
  state.tissue.ticks_since_network += ticks.ticks;
  state.remainder_s = ticks.remainder_s;
  state.poses.render_fraction = frame::passed_share(ticks, instance.asset->tick_s);
  take_pose(instance, context.teleport);
  keep_pose(instance);
  age(instance, false, context.frame_s);
  if (ticks.ticks > 0) follow_excitation(instance);
  if (!skins_on_reading(instance)) publish(instance);
}

}  // namespace sinew::world
