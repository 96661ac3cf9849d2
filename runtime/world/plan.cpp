// plan.cpp  see plan.hpp.
#include "world/plan.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "world/dormant.hpp"
#include "world/hidden.hpp"

namespace sinew::world {
namespace {

using frame::Candidate;

void refresh_front(const WorldState& world, Asset& asset) noexcept {
  if (!costs_are_measured(world)) return;
  frame::Level now[frame::kMostLevels];
  for (uint32_t i = 0; i < asset.point_count; ++i) {
    now[i] = asset.points[i];
    const frame::CostEstimate& tick = asset.cost.of(now[i].tier, now[i].graph);
    now[i].tick_us = tick.estimate_us() / static_cast<float>(now[i].every);
  }
  frame::make_front({now, asset.point_count}, asset.cost.publish.estimate_us(), &asset.front);
}

float idle_us(const WorldState& world, const Asset& asset) noexcept {
  return costs_are_measured(world) ? world.idle.estimate_us() : asset.idle_us;
}

// What it takes in this step if it is not simulated.
float base_us(const WorldState& world, const Instance& instance) noexcept {
  const Asset& asset = *instance.asset;
  if (!instance.displaced) return idle_us(world, asset);
  if (costs_are_measured(world)) return asset.cost.publish.estimate_us();
  return asset.idle_us + asset.cost.publish.baked_us();
}

float weight_of(const Instance& instance) noexcept {
  constexpr float kLargest = 1e30f;
  const InstanceState& state = *instance.state;
  return std::min(kLargest,
                  state.importance * instance.size * state.excitation * instance.asset->skinning_mm);
}

// The network is not to be had for a while after a guard; nothing is while a restart fades, or in the step in
// which one comes into view: how it moves is known a step later.
uint32_t highest(const Instance& instance) noexcept {
  const frame::Front& front = instance.asset->front;
  if (instance.state->restarting || instance.state->hidden) return 0;
  for (uint32_t level = 1; instance.state->fallback_ticks > 0 && level < front.count; ++level)
    if (front.levels[level].tier == Tier::kNetwork) return level - 1;
  return front.best();
}

Candidate candidate_of(const WorldState& world, const Instance& instance, uint32_t slot) noexcept {
  const InstanceState& state = *instance.state;
  const frame::Front& front = instance.asset->front;
  const uint32_t ticks = instance.plan.ticks.ticks;
  return {.slot = slot,
          .front = &front,
          .weight = weight_of(instance),
          .waited_s = state.waited_s,
          .held_s = state.held_s,
          .ticks = static_cast<float>(ticks),
          .cost_factor = costs_are_measured(world) ? instance.cost_factor : 1,
          .base_us = base_us(world, instance),
          .enter_us = costs_are_measured(world) ? instance.asset->cost.enter.estimate_us() : 0,
          .has = front.level_of(state.tier, instance.plan.every, state.level),
          .top = highest(instance),
          .turn_left_s = state.turn_left_s,
          .keeps_level = ticks == 0 && world.budget_us > 0 && !state.hidden};
}

// Instances of an age have the same ticks: they are worked out once.
class TickPlans {
 public:
  TickPlans(double dt_s, uint32_t most) noexcept : dt_s_(dt_s), most_(most) {}
  const frame::TickPlan& of(const Instance& instance) noexcept {
    const double remainder_s = instance.state->remainder_s, tick_s = instance.asset->tick_s;
    if (remainder_s != remainder_s_ || tick_s != tick_s_) {
      plan_ = frame::plan_ticks(remainder_s, dt_s_, tick_s, most_);
      remainder_s_ = remainder_s;
      tick_s_ = tick_s;
    }
    return plan_;
  }

 private:
  double dt_s_, remainder_s_ = -1, tick_s_ = 0;
  uint32_t most_;
  frame::TickPlan plan_;
};

constexpr uint32_t kNone = UINT32_MAX;

// Dormant, and below its best for longer than the one in that slot.
bool waits_longer(const WorldState& world, const InstanceState& state, uint32_t than) noexcept {
  if (state.dormant != static_cast<uint32_t>(Dormancy::kBelowBest)) return false;
  return than == kNone || state.held_s > world.instances.at(than)->state->held_s;
}

struct Gathered {
  uint32_t candidates = 0;
  uint32_t waiting = kNone;  // slot of the one that has had less than its best for longest
};

// All but the one that waits: what becomes of it is seen once the others are provided for.
void pass_dormant(WorldState& world, uint32_t slot, Gathered& gathered) noexcept {
  uint32_t passed = slot;
  if (waits_longer(world, *world.instances.at(slot)->state, gathered.waiting))
    passed = std::exchange(gathered.waiting, slot);
  if (passed != kNone) stay_dormant(*world.instances.at(passed));
}

Gathered gather_candidates(WorldState& world, double dt_s) noexcept {
  Gathered gathered;
  TickPlans plans(dt_s, world.def.max_ticks_per_step);
  world.idle_count = 0;
  for_each_instance(world, [&](Instance& instance, uint32_t slot) {
    if (!instance.seen) return pass_by(instance, dt_s, world.def.max_ticks_per_step);
    instance.plan.ticks = plans.of(instance);
    instance.plan.dt_s = dt_s;
    instance.passed = instance.state->dormant && world.budget_us > 0;
    if (instance.passed)
      pass_dormant(world, slot, gathered);
    else
      world.candidates[gathered.candidates++] = candidate_of(world, instance, slot);
  });
  return gathered;
}

// At its best once there is room for it beside all that is awake.
void raise_waiting(WorldState& world, float budget_us, Gathered& gathered,
                   frame::ScheduleResult& result) noexcept {
  Instance& instance = *world.instances.at(gathered.waiting);
  Candidate c = candidate_of(world, instance, gathered.waiting);
  c.level = c.top;
  c.reason = frame::Reason::kBest;
  const bool fits = !result.denied && result.planned_us + c.cost_us(c.top) <= budget_us;
  if (c.keeps_level) return stay_dormant(instance);
  if (!fits) {
    instance.state->held_s = 0;  // the next one's turn
    result.denied = true;
    return stay_dormant(instance);
  }
  instance.passed = false;
  result.planned_us += c.cost_us(c.top);
  world.candidates[gathered.candidates++] = c;
}

TierReason told(frame::Reason reason) noexcept {
  constexpr TierReason kTold[] = {TierReason::kBest, TierReason::kBudget, TierReason::kHeld,
                                  TierReason::kTurn};
  return kTold[static_cast<size_t>(reason)];
}

void take_answer(const WorldState& world, const Candidate& c, Instance& instance) noexcept {
  const frame::Level& level = c.front->levels[c.level];
  InstancePlan& plan = instance.plan;
  plan.why = told(c.reason);
  instance.state->turn_left_s = c.turn_left_s;
  plan.level = instance.state->level;
  if (c.keeps_level) {
    plan.tier = instance.state->tier;
    plan.cost_us = c.base_us;
    return;
  }
  const bool denied = c.level == 0;
  plan.tier = !denied ? level.tier
              : world.budget_us > 0 && !instance.state->restarting && !instance.state->hidden
                  ? Tier::kExtrapolate
                  : Tier::kSkinning;
  plan.every = denied ? 1 : level.every;
  if (!denied) plan.level = level.graph;
  plan.error = level.error;
  plan.cost_us = c.cost_us(c.level);
}

// Nothing of it is simulated, nothing of it is displaced.
bool is_idle(const Instance& instance) noexcept {
  return !frame::is_simulated(instance.plan.tier) && !instance.displaced && instance.shown_share() == 0 &&
         !instance.state->restarting && !instance.state->hidden;
}

// ---- order ----

uint32_t rank_of(const Candidate& c, const Instance& instance) noexcept {
  const bool simulated = frame::is_simulated(instance.plan.tier);
  constexpr float kCutLast = 1e20f;  // ahead of all the others, in their own order
  const float weight = std::clamp(c.weight, 1e-18f, 1e17f) * (instance.cut || instance.held ? kCutLast : 1);
  constexpr uint32_t kDrawersARank = frame::WeightBuckets::kCount / kRanks;
  const bool ranks = simulated || instance.cut || instance.held;
  return ranks ? frame::WeightBuckets::drawer_of(weight) / kDrawersARank : 0;
}

// Counting sort, largest first, to a quarter of an octave.
std::span<uint32_t> put_in_order(WorldState& world, std::span<const Candidate> candidates) noexcept {
  uint32_t* begins = world.rank_begins.get();  // [kRanks + 1]
  std::fill_n(begins, kRanks + 1, 0u);
  uint32_t count = 0;
  for (const Candidate& c : candidates) {
    Instance& instance = *world.instances.at(c.slot);
    instance.idle = is_idle(instance);
    if (instance.idle) {
      world.idle_slots[world.idle_count++] = c.slot;
      continue;
    }
    const uint32_t behind = kRanks - 1 - rank_of(c, instance);
    world.ranked[count++] = {c.slot, behind};
    ++begins[behind + 1];
  }
  for (uint32_t d = 0; d < kRanks; ++d) begins[d + 1] += begins[d];
  for (const Ranked& r : std::span(world.ranked.get(), count)) world.order[begins[r.behind]++] = r.slot;
  return {world.order.get(), count};
}

// Each is told what those behind it take in any case.
void add_up_behind(WorldState& world, std::span<const uint32_t> order) noexcept {
  float behind_us = static_cast<float>(world.idle_count) * world.idle.estimate_us();
  for (size_t i = order.size(); i-- > 0;) {
    Instance& instance = *world.instances.at(order[i]);
    instance.plan.behind_us = behind_us;
    if (instance.displaced) behind_us += instance.asset->cost.publish.estimate_us();
  }
}

}  // namespace

bool costs_are_measured(const WorldState& world) noexcept {
  return world.def.budget_mode == BudgetMode::kTime;
}

frame::ScheduleResult plan_step(WorldState& world, double dt_s) noexcept {
  for (uint32_t slot = 0; slot < world.assets.end(); ++slot)
    if (Asset* asset = world.assets.at(slot)) refresh_front(world, *asset);
  Gathered gathered = gather_candidates(world, dt_s);
  frame::ScheduleScratch& scratch = *world.scratch;
  float budget_us = world.budget_us;
  if (costs_are_measured(world) && budget_us > 0)
    budget_us = std::max(0.0f, budget_us - world.overhead.p95_us()) * world.capacity.scale();
  frame::ScheduleResult result =
      frame::schedule({world.candidates.get(), gathered.candidates}, budget_us, scratch);
  if (gathered.waiting != kNone) raise_waiting(world, budget_us, gathered, result);
  const std::span<const Candidate> candidates{world.candidates.get(), gathered.candidates};
  for (const Candidate& c : candidates) take_answer(world, c, *world.instances.at(c.slot));
  world.running = put_in_order(world, candidates);
  add_up_behind(world, world.running);
  return result;
}

}  // namespace sinew::world
