// step.cpp  One step of the world: plan, schedule, run, report.
#include "world/step.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/clock.hpp"
#include "core/run_tasks.hpp"
#include "world/hidden.hpp"
#include "world/look.hpp"

namespace sinew::world {
namespace {

using frame::Candidate;

Instance& instance_of(WorldState& world, const Candidate& candidate) noexcept {
  return *world.instances.at(candidate.slot);
}

bool costs_are_measured(const WorldState& world) noexcept {
  return world.def.budget_mode == BudgetMode::kTime;
}

float cost_us(const WorldState& world, const frame::CostEstimate& estimate) noexcept {
  return costs_are_measured(world) ? estimate.estimate_us() : estimate.baked_us();
}

Candidate plan_instance(const WorldState& world, Instance& instance, uint32_t slot, double dt_s) noexcept {
  const InstanceState& state = *instance.state;
  const Asset& asset = *instance.asset;
  instance.plan = {
      .ticks = frame::plan_ticks(state.remainder_s, dt_s, asset.tick_s, world.def.max_ticks_per_step),
      .dt_s = dt_s};
  const uint32_t ticks = instance.plan.ticks.ticks;
  Candidate candidate{
      .slot = slot,
      .importance = state.importance * instance.size,
      .waited_s = state.waited_s,
      .held_s = state.held_s,
      .base_us = cost_us(world, asset.cost.base),
      .best = asset.best(),
      .on_best = state.tier == asset.best(),
      .has_best = asset.best() != Tier::kNetwork || state.fallback_ticks == 0,
      .eligible = state.restarting == 0 && state.hidden == 0,  // how it moves is known a step later
      .keeps_tier = ticks == 0,
      .tier = state.tier};
  for (size_t tier = 0; tier < kTierCount; ++tier)
    candidate.cost_us[tier] = static_cast<float>(ticks) * cost_us(world, asset.cost.tick[tier]);
  return candidate;
}

std::span<Candidate> plan_instances(WorldState& world, double dt_s) noexcept {
  uint32_t count = 0;
  for (uint32_t slot = 0; slot < world.instances.end(); ++slot) {
    Instance* instance = world.instances.at(slot);
    if (!instance) continue;
    if (instance->seen)
      world.candidates[count++] = plan_instance(world, *instance, slot, dt_s);
    else
      pass_by(*instance, dt_s, world.def.max_ticks_per_step);
  }
  return {world.candidates.get(), count};
}

// True when the budget denied its best tier to an instance.
bool schedule_instances(WorldState& world, std::span<Candidate> candidates) noexcept {
  const float scale = costs_are_measured(world) ? world.capacity.scale() : 1;
  const bool denied = frame::schedule(candidates, world.budget_us * scale);
  for (const Candidate& candidate : candidates) instance_of(world, candidate).plan.tier = candidate.tier;
  return denied;
}

// Work units are spent when they are planned; time is spent when the clock says so.
float planned_us(std::span<const Candidate> candidates) noexcept {
  float sum = 0;
  for (const Candidate& c : candidates) {
    const bool ticks = frame::is_simulated(c.tier) && !c.keeps_tier;
    sum += c.base_us + (ticks ? c.cost_us[static_cast<size_t>(c.tier)] : 0);
  }
  return sum;
}

TickContext context_of(const WorldState& world, uint64_t start_ns) noexcept {
  TickContext context{.clock = world.def.clock,
                      .teleport_distance_m = world.def.teleport_distance_m,
                      .sleep_tolerance = world.def.sleep_tolerance};
  const bool limited = costs_are_measured(world) && world.budget_us > 0 && world.budget_us < 1e12f;
  if (limited) context.deadline_ns = start_ns + static_cast<uint64_t>(world.budget_us * 1e3);
  return context;
}

void run_one(void* argument, uint32_t index) {
  WorldState& world = *static_cast<WorldState*>(argument);
  step_instance(instance_of(world, world.candidates[index]), world.context);
}

void age(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const bool seated = state.tier == instance.asset->best();
  const float dt_s = static_cast<float>(instance.plan.dt_s);
  state.waited_s = seated ? 0 : state.waited_s + dt_s;
  state.held_s = seated ? state.held_s + dt_s : 0;
}

void correct_costs(Instance& instance) noexcept {
  frame::CostModel& cost = instance.asset->cost;
  const InstanceTimes& times = instance.times;
  const uint64_t ticked_ns = times.drive_ns + times.tissue_ns + times.rods_ns;
  cost.base.observe(core::microseconds(times.total_ns - ticked_ns));
  const Tier tier = instance.state->tier;
  const auto ticks = static_cast<float>(instance.plan.ticks.ticks);
  const bool told = frame::is_simulated(tier) && tier == instance.plan.tier && ticks > 0;  // no guard fired
  if (told) cost.tick[static_cast<size_t>(tier)].observe(core::microseconds(ticked_ns) / ticks);
}

void relax_costs(WorldState& world) noexcept {
  for (uint32_t slot = 0; slot < world.assets.end(); ++slot) {
    if (Asset* asset = world.assets.at(slot))
      std::ranges::for_each(asset->cost.tick, &frame::CostEstimate::relax);
  }
}

void count_tier(const Instance& instance, FrameReport& report) noexcept {
  const Tier tier = describe(instance, {}).tier;
  report.instances_network += tier == Tier::kNetwork;
  report.instances_modal += tier == Tier::kModal;
  report.instances_spring += tier == Tier::kSpring;
  report.instances_extrapolated += tier == Tier::kExtrapolate;
  report.instances_skinned += tier == Tier::kSkinning;
}

void add_to_report(const Instance& instance, FrameReport& report) noexcept {
  const frame::TickPlan& ticks = instance.plan.ticks;
  report.ticks = std::max(report.ticks, ticks.ticks);
  report.dropped_s = std::max(report.dropped_s, static_cast<float>(ticks.dropped_s));
  report.drive_us += core::microseconds(instance.times.drive_ns);
  report.tissue_us += core::microseconds(instance.times.tissue_ns);
  report.rods_us += core::microseconds(instance.times.rods_ns);
  report.publish_us += core::microseconds(instance.times.publish_ns);
  report.instances_cut += instance.cut;
  report.restarts += instance.restarted;
  report.fallbacks += instance.fell_back;
  report.regions_asleep += describe(instance, {}).regions_asleep;
  count_tier(instance, report);
}

// Serial and in slot order, so that sums do not depend on who ran when.
void fold_results(WorldState& world, FrameReport& report) noexcept {
  if (costs_are_measured(world)) relax_costs(world);
  for (uint32_t slot = 0; slot < world.instances.end(); ++slot) {
    Instance* instance = world.instances.at(slot);
    if (!instance) continue;
    report.instances_hidden += !instance->seen;
    if (!instance->seen) continue;
    age(*instance);
    if (costs_are_measured(world)) correct_costs(*instance);
    add_to_report(*instance, report);
  }
}

}  // namespace

FrameReport step(WorldState& world, float dt_s) noexcept {
  const uint64_t start_ns = core::now_ns(world.def.clock);
  FrameReport report{.frame = world.frames++, .budget_us = world.budget_us};
  look(world);
  const std::span<Candidate> candidates = plan_instances(world, frame::exact_seconds(dt_s));
  const bool denied = schedule_instances(world, candidates);
  world.context = context_of(world, start_ns);
  report.schedule_us = core::microseconds(core::now_ns(world.def.clock) - start_ns);
  core::run_tasks(world.def.tasks, run_one, &world, static_cast<uint32_t>(candidates.size()));
  fold_results(world, report);
  report.rejected_poses = std::exchange(world.rejected_poses, 0u);
  report.total_us = core::microseconds(core::now_ns(world.def.clock) - start_ns);
  report.over_budget =
      (costs_are_measured(world) ? report.total_us : planned_us(candidates)) > report.budget_us;
  world.capacity.observe(report.total_us, report.budget_us, denied);
  return report;
}

}  // namespace sinew::world
