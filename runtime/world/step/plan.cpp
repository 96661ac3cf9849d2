// plan.cpp  see plan.hpp.
#include "world/step/plan.hpp"

#include <algorithm>
#include <limits>
#include <new>

#include "character/asset/affords_surface.hpp"
#include "character/rest/dormant.hpp"
#include "character/rest/hidden.hpp"
#include "world/step/skip_pose.hpp"

namespace sinew::world {
namespace {

using frame::Candidate;

void refresh_front(const Asset& asset, TierCosts& costs) noexcept {
  frame::Level now[frame::kMostLevels];
  for (uint32_t i = 0; i < asset.point_count; ++i) {
    now[i] = asset.points[i];
    const frame::CostEstimate& tick = costs.cost.of(now[i].tier, now[i].graph);
    now[i].tick_us = tick.estimate_us();
  }
  const float publish_us = costs.cost.publish.estimate_us();
  frame::make_front({now, asset.point_count}, publish_us, &costs.front);
  if (costs.limited) make_modal_front({now, asset.point_count}, publish_us, &costs);
}

void refresh_fronts(const WorldState& world, Asset& asset) noexcept {
  if (!costs_are_measured(world)) return;
  refresh_front(asset, asset.costs);
  if (asset.surface_instances > 0) refresh_front(asset, asset.surface_costs);
}

// What may be bought of it.
const frame::Front& front_of(const PlanRow& row) noexcept {
  const TierCosts& costs = costs_of(row);
  return row.modal_at_best ? costs.modal_front : costs.front;
}

// What is asked of all candidates of a step alike.
struct Terms {
  bool measured, has_budget;
  float idle_us;  // measured
};

Terms terms_of(const WorldState& world) noexcept {
  return {costs_are_measured(world), world.budget_us > 0, world.costs.idle.estimate_us()};
}

// Of one that is simulated, the provisional step that this one ends on between two ticks, as a share of a
// tick.
float between_share(const Terms& terms, const PlanRow& row, const frame::TickPlan& plan) noexcept {
  const frame::CostEstimate& between = costs_of(row).cost.between(row.tier);
  if (frame::passed_share(plan, row.asset->tick_s) == 0) return 0;
  return terms.measured ? between.estimate_us() : between.baked_us();
}

// The same without a tick, in which it keeps what it has.
float between_us(const Terms& terms, const PlanRow& row, const frame::TickPlan& plan) noexcept {
  if (plan.ticks > 0 || !frame::is_simulated(row.tier)) return 0;
  const frame::CostEstimate& tick = costs_of(row).cost.of(row.tier, row.level);
  const float tick_us = terms.measured ? row.cost_factor * tick.estimate_us() : tick.baked_us();
  return between_share(terms, row, plan) * tick_us;
}

// What it takes in this step if it is not simulated.
float base_us(const Terms& terms, const PlanRow& row) noexcept {
  const Asset& asset = *row.asset;
  if (terms.measured && row.hidden) return costs_of(row).cost.come_back.estimate_us();
  if (!row.displaced) return terms.measured ? terms.idle_us : asset.idle_us;
  if (terms.measured) return costs_of(row).cost.publish.estimate_us();
  return asset.idle_us + costs_of(row).cost.publish.baked_us();
}

float weight_of(const PlanRow& row) noexcept {
  constexpr float kLargest = 1e30f;
  return std::min(kLargest, row.importance * row.size * row.excitation * row.asset->skinning_mm);
}

// Who rose to skin and was cut, or rose elsewhere, does not try again for a while: near its price skin would
// be taken and left several times a second.
uint8_t below_skin(const Terms& terms, const PlanRow& row) noexcept {
  constexpr float kAgain_s = 2;
  const frame::Front& front = front_of(row);
  const bool waits =
      terms.measured && row.has_surface && row.held_s < kAgain_s && !affords_surface(row.tier, row.level);
  for (uint8_t level = 2; waits && level < front.count; ++level)
    if (affords_surface(front.levels[level].tier, front.levels[level].graph))
      return static_cast<uint8_t>(level - 1);
  return front.best();
}

// The network is not to be had for a while after a guard; nothing is while a restart fades, in the step in
// which one comes into view: how it moves is known a step later, or where all of it is off or may only be
// skinned.
uint8_t highest(const Terms& terms, const PlanRow& row) noexcept {
  const frame::Front& front = front_of(row);
  if (row.restarting || row.hidden || row.all_off || row.skinned_at_best) return 0;
  for (uint8_t level = 1; row.falls_back && level < front.count; ++level)
    if (front.levels[level].tier == Tier::kNetwork) return static_cast<uint8_t>(level - 1);
  return below_skin(terms, row);
}

// The best that touches skin takes in one of a hundred ticks, beyond what it is expected to.
float skin_tail_us(const PlanRow& row) noexcept {
  float most = 0;
  for (const Tier tier : {Tier::kModal, Tier::kNetwork}) {
    const frame::CostEstimate& tick = costs_of(row).cost.of(tier, 0);
    if (tick.is_known()) most = std::max(most, tick.p99_us() - tick.estimate_us());
  }
  return row.cost_factor * most;
}

// Who goes to skin is to stay there: the deadline is kept by what it takes at most.
float change_us(const PlanRow& row, uint32_t ticks) noexcept {
  const float skin_us = row.has_surface && row.level > 0 ? static_cast<float>(ticks) * skin_tail_us(row) : 0;
  return costs_of(row).cost.change.estimate_us() + skin_us;
}

Candidate candidate_of(const Terms& terms, const PlanRow& row, const frame::TickPlan& plan,
                       uint32_t slot) noexcept {
  const uint32_t ticks = plan.ticks;
  const bool keeps_level = ticks == 0 && terms.has_budget && !row.hidden;
  const frame::Front& front = front_of(row);
  return {.front = &front,
          .slot = slot,
          .weight = weight_of(row),
          .waited_s = row.waited_s,
          .held_s = row.held_s,
          .ticks = static_cast<float>(ticks) + between_share(terms, row, plan),
          .cost_factor = terms.measured ? row.cost_factor : 1,
          .base_us = base_us(terms, row) + (keeps_level ? between_us(terms, row, plan) : 0),
          .enter_us = terms.measured ? costs_of(row).cost.enter.estimate_us() : 0,
          .change_us = terms.measured ? change_us(row, ticks) : 0,
          .turn_left_s = row.turn_left_s,
          .missed = terms.measured ? row.missed : uint8_t{0},
          .has = front.level_of(row.tier, row.level),
          .graph = row.level,
          .top = highest(terms, row),
          .keeps_level = keeps_level};
}

void sleep_on(WorldState& world, uint32_t slot, const frame::TickPlan& ticks) noexcept {
  Instance& instance = *world.instances.at(slot);
  PlanRow& row = world.rows[slot];
  instance.plan.ticks = ticks;
  instance.plan.dt_s = own_step_s(world, *row.state);
  forget_skipped(*row.state);
  row.waited_for_pose = false;
  instance.marks.passed = true;
  stay_dormant(instance, world.dt_s);
  row.remainder_s = row.state->remainder_s;
  row.held_s = row.state->held_s;
  row.turn_left_s = row.state->turn_left_s;
  row.cost_factor = instance.cost_factor;
  row.was_cut = false;
}

void wait(WorldState& world, uint32_t slot) noexcept {
  Instance& instance = *world.instances.at(slot);
  wait_for_pose(instance, world.dt_s);
  copy_to_row(instance, &world.rows[slot]);
}

void pass_unseen(WorldState& world, uint32_t slot, const frame::TickPlan& ticks) noexcept {
  PlanRow& row = world.rows[slot];
  if (!row.hidden) {
    Instance& instance = *world.instances.at(slot);
    hide(instance);
    copy_to_row(instance, &row);
  }
  if (row.skips_pose || row.waited_for_pose) {  // it has no motion that would have to wait
    forget_skipped(*row.state);
    row.skips_pose = row.waited_for_pose = false;
  }
  pass_by(ticks, row);
}

// What comes next is waited for by then: rows in any case, of those that are passed over also they
// themselves.
void bring_next_near(const WorldState& world, uint32_t slot, uint32_t candidate) noexcept {
  constexpr uint32_t kRowsAhead = 16, kAhead = 8;
  if (slot + kRowsAhead >= world.instances.end()) return;
  __builtin_prefetch(&world.rows[slot + kRowsAhead]);
  __builtin_prefetch(&world.planning.answers[slot + kRowsAhead], 1);
  core::bring_near(&world.planning.candidates[candidate + kAhead], sizeof(Candidate));
  const PlanRow& row = world.rows[slot + kAhead];
  if (row.dormant || (!row.seen && !row.hidden)) bring_instance_near(world, slot + kAhead);
}

void count_ticks(const frame::TickPlan& plan, WorldState& world) noexcept {
  world.ticks = std::max(world.ticks, plan.ticks);
  world.dropped_s = std::max(world.dropped_s, static_cast<float>(plan.dropped_s));
}

uint32_t gather_candidates(WorldState& world) noexcept {
  uint32_t count = 0;
  frame::TickPlans plans = tick_plans(world);
  const Terms terms = terms_of(world);
  world.ticks = 0;
  world.dropped_s = 0;
  for_each_row(world, [&](PlanRow& row, uint32_t slot) {
    bring_next_near(world, slot, count);
    world.planning.answers[slot].idle = false;
    if (row.seen && row.skips_pose && !row.hidden) return wait(world, slot);
    const frame::TickPlan ticks = own_ticks(world, row, plans);
    if (!row.seen) return pass_unseen(world, slot, ticks);
    count_ticks(ticks, world);
    if (row.dormant && terms.has_budget)
      sleep_on(world, slot, ticks);
    else  // made where it stays: a copy would wait for what has just been written
      new (&world.planning.candidates[count++]) Candidate(candidate_of(terms, row, ticks, slot));
  });
  return count;
}

// Of frame::Reason.
constexpr TierReason kTold[] = {TierReason::kBest, TierReason::kBudget, TierReason::kHeld, TierReason::kTurn};

// Nothing of it is simulated, nothing of it is displaced.
bool is_idle(const PlanRow& row, Tier tier) noexcept {
  return !(frame::is_simulated(tier) | row.displaced | row.shows | row.restarting | row.hidden);
}

// Who has what is hard to foretell: no branch depends on it.
void give_answer(bool has_budget, const PlanRow& row, const Candidate& c, PlanAnswer& plan) noexcept {
  const frame::Level& level = c.front->levels[c.level];
  const bool carried = has_budget & !row.restarting & !row.hidden & !row.skinned_at_best, none = c.level == 0;
  const Tier given = (none & !carried) ? Tier::kSkinning : level.tier;  // of level 0: extrapolated
  const uint32_t graph = (c.keeps_level | none) ? row.level : level.graph;
  const Tier tier = c.keeps_level ? Tier{row.tier} : given;
  const bool idle = is_idle(row, tier);
  plan.decision.cost_us = c.planned_us;
  plan.turn_left_s = c.turn_left_s;
  plan.decision.why = kTold[static_cast<size_t>(c.reason)];
  plan.decision.tier = tier;
  plan.decision.level = static_cast<uint8_t>(graph);
  plan.idle = idle;
}

// ---- order ----

uint32_t rank_of(const Candidate& c, const PlanRow& row, const PlanAnswer& plan) noexcept {
  constexpr float kCutLast = 1e20f;  // ahead of all the others, in their own order
  const float weight = std::clamp(c.weight, 1e-18f, 1e17f) * (row.was_cut ? kCutLast : 1);
  constexpr uint32_t kDrawersARank = frame::WeightBuckets::kCount / kRanks;
  const bool ranks = frame::is_simulated(plan.decision.tier) || row.was_cut;
  return ranks ? frame::WeightBuckets::drawer_of(weight) / kDrawersARank : 0;
}

// Counting sort, largest first, to a quarter of an octave.
class Ranking {
 public:
  explicit Ranking(WorldState& world) noexcept : world_(world) {}

  // Written wherever it may belong, and counted where it does: who is idle is hard to foretell.
  void add(const Candidate& c, const PlanRow& row, const PlanAnswer& plan) noexcept {
    const uint32_t behind = kRanks - 1 - rank_of(c, row, plan), active = !plan.idle;
    world_.order.idle_slots[idle_] = c.slot;
    idle_ += plan.idle;
    world_.order.ranked[count_] = {c.slot, behind};
    count_ += active;
    world_.order.rank_begins[behind + 1] += active;
    first_ = std::min(first_, behind);
    last_ = std::max(last_, behind);
  }
  // Leaves the counts at zero, as they were found.
  std::span<uint32_t> put_in_order() noexcept {
    world_.order.idle_count = idle_;
    uint32_t* begins = world_.order.rank_begins.get();  // [kRanks + 1]
    uint32_t before = 0;
    for (uint32_t d = first_; d <= last_; ++d) begins[d] = before += begins[d];
    for (const Ranked& r : std::span(world_.order.ranked.get(), count_))
      world_.order.slots[begins[r.behind]++] = r.slot;
    if (first_ <= last_) std::fill(begins + first_, begins + last_ + 2, 0u);
    return {world_.order.slots.get(), count_};
  }

 private:
  WorldState& world_;
  uint32_t count_ = 0, idle_ = 0, first_ = kRanks, last_ = 0;
};

float in_any_case_us(const WorldState& world, const PlanRow& row, frame::TickPlans& plans) noexcept {
  const frame::CostModel& cost = costs_of(row).cost;
  if (row.hidden) return cost.come_back.estimate_us();
  if (!row.displaced) return 0;
  return cost.publish.estimate_us() + between_us(terms_of(world), row, own_ticks(world, row, plans));
}

// Each is told what those behind it take in any case.
void add_up_behind(WorldState& world, std::span<const uint32_t> order) noexcept {
  const float handing_us = world.def.tasks.enqueue ? 0 : world.costs.between.estimate_us();
  frame::TickPlans plans = tick_plans(world);
  float behind_us = static_cast<float>(world.order.idle_count) * world.costs.idle.p95_us();
  for (size_t i = order.size(); i-- > 0;) {
    const PlanRow& row = world.rows[order[i]];
    world.planning.answers[order[i]].decision.behind_us = behind_us;
    behind_us += handing_us;
    behind_us += in_any_case_us(world, row, plans);
  }
}

}  // namespace

bool costs_are_measured(const WorldState& world) noexcept {
  return world.def.budget_mode == BudgetMode::kTime;
}

frame::ScheduleResult plan_step(WorldState& world, double dt_s) noexcept {
  world.dt_s = dt_s;
  for (uint32_t slot = 0; slot < world.assets.end(); ++slot)
    if (Asset* asset = world.assets.at(slot)) refresh_fronts(world, *asset);
  const std::span<Candidate> candidates{world.planning.candidates.get(), gather_candidates(world)};
  frame::ScheduleScratch& scratch = *world.planning.scratch;
  float budget_us = world.budget_us;
  if (costs_are_measured(world) && budget_us > 0)
    budget_us = std::max(0.0f, budget_us - world.costs.overhead.p95_us()) * world.costs.capacity.scale();
  const frame::ScheduleResult result = frame::schedule(candidates, budget_us, scratch);
  Ranking ranking(world);
  const bool has_budget = world.budget_us > 0;
  for (const Candidate& c : candidates) {
    const PlanRow& row = world.rows[c.slot];
    give_answer(has_budget, row, c, world.planning.answers[c.slot]);
    ranking.add(c, row, world.planning.answers[c.slot]);
  }
  world.order.running = ranking.put_in_order();
  add_up_behind(world, world.order.running);
  return result;
}

}  // namespace sinew::world
