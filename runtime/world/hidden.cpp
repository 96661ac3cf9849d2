// hidden.cpp  see hidden.hpp.
#include "world/hidden.hpp"

#include <algorithm>

#include "frame/scheduler.hpp"
#include "world/blend.hpp"
#include "world/dormant.hpp"

namespace sinew::world {
namespace {

// The pose set last, as if it had always been there.
void hold_pose(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  if (!state.has_next || state.at_start) return;
  const uint32_t joints = instance.level->pack.character->joint_count;
  std::copy_n(instance.next_joints, joints, instance.joints);
  std::copy_n(instance.next_joints, joints, instance.joints_before);
  state.root = state.next_root;
  state.dt_before_s = 0;
  state.teleported = 0;
  std::fill_n(state.velocity_m_s, 3, 0.0);
  std::fill_n(state.angular_velocity, 3, 0.0);
}

}  // namespace

void pass_by(Instance& instance, double dt_s, uint32_t max_ticks) noexcept {
  InstanceState& state = *instance.state;
  const frame::TickPlan plan = frame::plan_ticks(state.remainder_s, dt_s, instance.asset->tick_s, max_ticks);
  state.remainder_s = plan.remainder_s;
  const uint32_t longest = UINT32_MAX / 2;
  state.hidden_ticks = std::min(longest, state.hidden_ticks + plan.ticks);
  if (plan.dropped_s > 0) state.hidden_ticks = std::max(state.hidden_ticks, kCarryTicks + kFadeTicks);
  if (state.hidden) return;
  state.hidden = 1;
  wake(instance);
  state.still_ticks = 0;
  state.waited_s = state.held_s = 0;
  instance.times = {};
  instance.cost_factor = 1;
  instance.told = {};
  instance.cut = instance.held = instance.restarted = instance.fell_back = false;
}

void come_back(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  hold_pose(instance);
  if (frame::is_simulated(state.tier)) enter_tier(instance, Tier::kExtrapolate);
  if (state.hidden_ticks >= kCarryTicks + kFadeTicks) {
    show_nothing(instance);
  } else {
    for (uint32_t tick = 0; tick < state.hidden_ticks; ++tick) show_tick(instance);
  }
  state.motion_stale = 1;
  state.ticks_since_network += state.hidden_ticks;
  state.fallback_ticks -= std::min(state.fallback_ticks, state.hidden_ticks);
  state.hidden = state.hidden_ticks = 0;
}

}  // namespace sinew::world
