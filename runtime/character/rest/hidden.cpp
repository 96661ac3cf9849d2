// hidden.cpp  see hidden.hpp.
#include "character/rest/hidden.hpp"

#include <algorithm>

#include "character/motion/root_motion.hpp"
#include "character/motion/teleport.hpp"
#include "character/rest/asleep.hpp"
#include "character/transition/blend.hpp"

namespace sinew::world {
namespace {

// The pose set last, as if it had always been there.
void hold_pose(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  if (!state.poses.has_next || state.poses.at_start) return;
  const uint32_t joints = instance.level->pack.character->joint_count;
  std::copy_n(instance.motion.next_joints, joints, instance.motion.joints);
  std::copy_n(instance.motion.next_joints, joints, instance.motion.joints_before);
  state.motion.root = state.motion.next_root;
  keep_space(instance);
  state.motion.dt_before_s = 0;
  forget_teleports(instance);
  std::fill_n(state.motion.velocity_m_s, 3, 0.0);
  std::fill_n(state.motion.angular_velocity, 3, 0.0);
}

}  // namespace

void hide(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  state.hidden = 1;
  wake(instance);
  state.waited_s = state.held_s = 0;
  instance.times = {};
  instance.cost_factor = 1;
  instance.told = {};
  instance.marks.cut = instance.marks.held = instance.marks.restarted = instance.marks.fell_back = false;
}

void come_back(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  hold_pose(instance);
  if (frame::is_simulated(state.tier)) enter_tier(instance, Tier::kExtrapolate);
  if (state.transition.hidden_ticks >= kCarryTicks + state.transition.fade_ticks) {
    show_nothing(instance);
  } else {
    for (uint32_t tick = 0; tick < state.transition.hidden_ticks; ++tick) show_tick(instance);
  }
  state.poses.motion_stale = 1;
  state.poses.still_ticks = 0;
  state.tissue.ticks_since_network += state.transition.hidden_ticks;
  state.fallback_ticks -= std::min(state.fallback_ticks, state.transition.hidden_ticks);
  state.hidden = state.transition.hidden_ticks = 0;
}

}  // namespace sinew::world
