// fold.cpp  see fold.hpp.
#include "world/step/fold.hpp"

#include <algorithm>

#include "character/asset/affords_surface.hpp"
#include "character/rest/asleep.hpp"
#include "character/transition/catch_up.hpp"
#include "core/clock.hpp"
#include "world/step/plan.hpp"

namespace sinew::world {
namespace {

bool ran_as_planned(const Instance& instance, const PlanRow& row) noexcept {
  return row.tier == instance.plan.decision.tier && !instance.marks.restarted && !instance.marks.fell_back;
}

frame::CostEstimate& tick_cost(const PlanRow& row) noexcept {
  return costs_of(row).cost.of(row.tier, row.level);
}

// A sleeper's or a toucher's own cost is its factor; the asset's is that of those who are awake. Who has a
// skin to touch counts for no less unless it sleeps on it: that sleep is cheap on capsules says nothing of
// skin.
void learn_tick_cost(Instance& instance, const PlanRow& row, float tick_us) noexcept {
  constexpr float kWeight = 0.125f, kFarthest = 2, kLeast = 0.1f, kMost = 10;
  frame::CostEstimate& estimate = tick_cost(row);
  float& factor = instance.cost_factor;
  if (row.regions_asleep == 0) estimate.observe(tick_us);
  const float seen = tick_us / std::max(1e-3f, estimate.estimate_us());
  factor += kWeight * (std::clamp(seen, factor / kFarthest, factor * kFarthest) - factor);
  const bool sleeps_on_skin = affords_surface(row.tier, row.level) && rods_asleep(instance) > 0;
  factor = std::clamp(factor, row.has_surface && !sleeps_on_skin ? 1 : kLeast, kMost);
}

// Of those who are awake, as a tick's own.
bool ran_between(const Instance& instance, const PlanRow& row) noexcept {
  return frame::is_simulated(row.tier) && !instance.marks.held && row.regions_asleep == 0 &&
         instance.times.between_ns > 0;
}

void learn_between(const Instance& instance, const PlanRow& row, float took_us) noexcept {
  const float tick_us = tick_cost(row).estimate_us() * instance.cost_factor;
  if (tick_us > 0) costs_of(row).cost.between(row.tier).observe(took_us / tick_us);
}

// What it took beyond its ticks.
void learn_beyond(const Instance& instance, const PlanRow& row, float took_us,
                  frame::CostEstimate& to) noexcept {
  const float tick_us = tick_cost(row).estimate_us();
  const auto ticks = static_cast<float>(instance.plan.ticks.ticks);
  constexpr float kMost = 10;  // of a tick: a first sample is not clipped by those before it
  to.observe(std::clamp(took_us - ticks * tick_us, 0.0f, kMost * tick_us));
}

void learn_coming_back(float took_us, frame::CostModel& cost) noexcept {
  constexpr float kMost = 4;  // of publishing: a first sample is not clipped by those before it
  if (!cost.come_back.is_known()) took_us = std::min(took_us, kMost * cost.publish.estimate_us());
  cost.come_back.observe(took_us);
}

void learn_costs(Instance& instance, const PlanRow& row) noexcept {
  const InstanceTimes& times = instance.times;
  frame::CostModel& cost = costs_of(row).cost;
  const uint64_t ticked_ns = times.drive_ns + times.tissue_ns + times.rods_ns;
  const float ticked_us = core::microseconds(ticked_ns);
  if (instance.marks.came_back) return learn_coming_back(core::microseconds(times.total_ns), cost);
  const bool ran = frame::is_simulated(row.tier) && instance.plan.ticks.ticks > 0 &&
                   (ran_as_planned(instance, row) || instance.marks.cut);
  if (instance.marks.changed_level) {
    const float took_us = core::microseconds(times.total_ns) - cost.publish.estimate_us();
    if (ran && instance.marks.entered)
      learn_beyond(instance, row, took_us, cost.enter);
    else if (ran && instance.marks.refined)
      learn_beyond(instance, row, took_us, cost.change);
    return;
  }
  if (instance.marks.displaced && !instance.marks.held)
    cost.publish.observe(core::microseconds(times.total_ns - ticked_ns - instance.times.between_ns));
  if (ran_between(instance, row)) learn_between(instance, row, core::microseconds(instance.times.between_ns));
  if (ran && instance.marks.entered)
    learn_beyond(instance, row, ticked_us, cost.enter);
  else if (ran)
    learn_tick_cost(instance, row,
                    ticked_us / static_cast<float>(instance.plan.ticks.ticks + instance.marks.made_up));
}

void count_tier(Tier tier, FrameReport& report) noexcept {
  report.instances_network += tier == Tier::kNetwork;
  report.instances_modal += tier == Tier::kModal;
  report.instances_extrapolated += tier == Tier::kExtrapolate;
  report.instances_skinned += tier == Tier::kSkinning;
}

void add_times(const Instance& instance, FrameReport& report) noexcept {
  report.drive_us += core::microseconds(instance.times.drive_ns);
  report.tissue_us += core::microseconds(instance.times.tissue_ns);
  report.rods_us += core::microseconds(instance.times.rods_ns);
  report.publish_us += core::microseconds(instance.times.publish_ns);
}

// Returns its expected error.
float add_active(const Instance& instance, const PlanRow& row, FrameReport& report) noexcept {
  add_times(instance, report);
  report.instances_cut += row.was_cut;
  report.restarts += instance.marks.restarted;
  report.fallbacks += instance.marks.fell_back;
  report.regions_asleep += row.regions_asleep;
  count_tier(frame::is_simulated(row.tier) || row.shows ? row.tier : Tier::kSkinning, report);
  return error_of(*row.asset, row.tier, row.level);
}

// Likewise, of one that is dormant or waits for a pose.
float add_passed(const Instance& instance, const PlanRow& row, FrameReport& report) noexcept {
  const Tier tier = instance.state->tier;
  report.instances_dormant += row.dormant;
  report.regions_asleep += row.regions_asleep;
  const bool shows = frame::is_simulated(tier) || row.shows;
  count_tier(shows ? tier : Tier::kSkinning, report);
  return shows ? error_of(*instance.asset, tier, instance.state->level) : 1;
}

float add_idle(FrameReport& report) noexcept {
  ++report.instances_skinned;
  return 1;
}

// On skin it comes back awake, but where what it missed is made up for.
bool forgets_its_sleep(const Instance& instance, const PlanRow& row) noexcept {
  return row.has_surface && !frame::is_simulated(row.tier) && missed_so_far(instance) == 0;
}

void log_events(WorldState& world, const Instance& instance, uint32_t slot, uint64_t frame) noexcept {
  const InstanceId id = world.instances.id_at(slot);
  for (uint32_t kind = 0; instance.marks.events >> kind; ++kind)
    if (instance.marks.events >> kind & 1u)
      log_event(world.events, {static_cast<EventKind>(kind), id, frame});
}

float add(WorldState& world, uint32_t slot, FrameReport& report) noexcept {
  if (world.planning.answers[slot].idle) return add_idle(report);
  Instance& instance = *world.instances.at(slot);
  if (instance.marks.passed) return add_passed(instance, world.rows[slot], report);
  world.order.busy_ns += instance.times.total_ns;
  if (instance.marks.events) log_events(world, instance, slot, report.frame);
  if (costs_are_measured(world)) learn_costs(instance, world.rows[slot]);
  if (forgets_its_sleep(instance, world.rows[slot]))
    instance.cost_factor = std::max(1.0f, instance.cost_factor);
  world.rows[slot].cost_factor = instance.cost_factor;
  if (instance.marks.cut || instance.marks.held) world.order.undone_us += instance.plan.decision.cost_us;
  return add_active(instance, world.rows[slot], report);
}

void settle(Asset& asset) noexcept {
  asset.costs.cost.settle();
  if (asset.surface_instances > 0) asset.surface_costs.cost.settle();
}

void bring_counted_near(const WorldState& world, uint32_t slot) noexcept {
  constexpr uint32_t kAhead = 8;
  const uint32_t ahead = slot + kAhead;
  if (ahead >= world.instances.end()) return;
  const PlanRow& row = world.rows[ahead];
  if (row.asset && row.seen && !world.planning.answers[ahead].idle)
    world.instances.bring_near(ahead, kPlannedBytes);
}

}  // namespace

void fold_results(WorldState& world, FrameReport& report) noexcept {
  double errors = 0;
  uint32_t seen = 0;
  world.order.undone_us = 0;
  world.order.busy_ns = 0;
  report.ticks = world.ticks;
  report.dropped_s = world.dropped_s;
  for_each_row(world, [&](const PlanRow& row, uint32_t slot) {
    bring_counted_near(world, slot);
    report.instances_hidden += !row.seen;
    if (!row.seen) return;
    ++seen;
    errors += static_cast<double>(add(world, slot, report));
  });
  if (seen > 0) report.expected_error = static_cast<float>(errors / seen);
  for (uint32_t slot = 0; costs_are_measured(world) && slot < world.assets.end(); ++slot)
    if (Asset* asset = world.assets.at(slot)) settle(*asset);
}

}  // namespace sinew::world
