// plan_row.cpp  see plan_row.hpp.
#include "world/step/plan_row.hpp"

#include <algorithm>

#include "character/parameters/tuning.hpp"
#include "character/rest/asleep.hpp"
#include "character/transition/catch_up.hpp"
#include "character/transition/shares.hpp"
#include "schedule/front.hpp"

namespace sinew::world {

static_assert(kBlindLooks < 4);

void copy_to_row(const Instance& instance, PlanRow* row) noexcept {
  const InstanceState& state = *instance.state;
  row->remainder_s = state.remainder_s;
  row->hidden_ticks = state.transition.hidden_ticks;
  row->importance = state.importance;
  row->excitation = state.excitation;
  row->waited_s = state.waited_s;
  row->held_s = state.held_s;
  row->turn_left_s = state.turn_left_s;
  row->cost_factor = instance.cost_factor;
  row->tier = state.tier;
  row->level = static_cast<uint8_t>(state.level);
  row->dormant = static_cast<uint8_t>(state.dormant);
  row->restarting = state.restarting != 0;
  row->hidden = state.hidden != 0;
  row->hidden_by_caller = state.hidden_by_caller != 0;
  row->displaced = instance.marks.displaced;
  row->scaled = state.poses.time_scale != 1;
  row->skips_pose = state.poses.skips_pose != 0;
  row->waited_for_pose = state.poses.without_pose_s > 0;
  row->falls_back = state.fallback_ticks > 0;
  row->was_cut = instance.marks.cut || instance.marks.held;
  row->shows = shown_share(instance) != 0;
  row->blind_looks = std::min(state.blind_looks, kBlindLooks) & 3;
  row->missed = missed_so_far(instance) & 3;
  row->all_off = all_is_off(instance);
  row->modal_at_best = state.tier_limit == Tier::kModal;
  row->skinned_at_best = state.tier_limit == Tier::kSkinning;
  row->regions_asleep =
      frame::is_simulated(state.tier) ? static_cast<uint16_t>(regions_asleep(instance)) : uint16_t{0};
}

void pass_by(const frame::TickPlan& ticks, PlanRow& row) noexcept {
  constexpr uint32_t kLongest = UINT32_MAX / 2;
  row.remainder_s = ticks.remainder_s;
  row.hidden_ticks = std::min(kLongest, row.hidden_ticks + ticks.ticks);
  if (ticks.dropped_s > 0) row.hidden_ticks = std::max(row.hidden_ticks, kCarryTicks + kLongestFadeTicks);
}

void keep_hidden_ticks(const PlanRow& row) noexcept {
  if (!row.hidden) return;
  row.state->remainder_s = row.remainder_s;
  row.state->transition.hidden_ticks = row.hidden_ticks;
}

}  // namespace sinew::world
