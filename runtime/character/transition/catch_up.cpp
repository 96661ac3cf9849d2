// catch_up.cpp  see catch_up.hpp.
#include "character/transition/catch_up.hpp"

#include "character/rods/rod_blend.hpp"
#include "character/transition/simulated_shown.hpp"

namespace sinew::world {

uint32_t missed_so_far(const Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const bool near = state.transition.missed_ticks <= kCaughtUpTicks && !state.poses.motion_stale;
  const bool left = state.tier == Tier::kExtrapolate && frame::is_simulated(state.left_tier);
  return near && left ? state.transition.missed_ticks : 0u;
}

namespace {

// Between three of them or, where frames are as long as ticks, a frame before these.
bool knows_poses(const Instance& instance) noexcept {
  constexpr double kAsLong = 0.75, kRounding_s = 1e-9;
  const InstanceState& state = *instance.state;
  const double tick_s = instance.asset->tick_s, dt_s = instance.plan.dt_s;
  const double first_s = instance.plan.ticks.first_tick_s - state.transition.missed_ticks * tick_s;
  const double back_s = state.motion.dt_before_s + (dt_s >= kAsLong * tick_s ? dt_s : 0);
  return first_s >= -back_s - kRounding_s;
}

// On the level that it has, which a finer one for the same tier or a network waits for, or on a coarser one,
// whose nodes keep what they had.
bool may_go_on(const Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const InstancePlan& plan = instance.plan;
  return plan.decision.level >= state.level || plan.decision.tier == state.left_tier ||
         plan.decision.tier == Tier::kNetwork;
}

}  // namespace

bool catches_up(const Instance& instance) noexcept {
  const InstancePlan& plan = instance.plan;
  return frame::is_simulated(plan.decision.tier) && missed_so_far(instance) > 0 && may_go_on(instance) &&
         plan.ticks.ticks > 0 && !(plan.ticks.dropped_s > 0) && knows_poses(instance);
}

bool catch_up_first(Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  if (instance.plan.decision.level >= state.level || !catches_up(instance)) return false;
  instance.plan.decision.tier = state.left_tier;
  instance.plan.decision.level = static_cast<uint8_t>(state.level);
  return true;
}

void begin_gap(Instance& instance) noexcept {
  instance.state->left_tier = instance.state->tier;
  instance.state->transition.missed_ticks = 0;
}

void miss_tick(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  if (state.transition.missed_ticks <= kCaughtUpTicks) ++state.transition.missed_ticks;
  if (state.transition.missed_ticks > kCaughtUpTicks || state.tier != Tier::kExtrapolate)
    state.poses.motion_stale = 1;
}

void end_gap(Instance& instance, bool catches_up) noexcept {
  InstanceState& state = *instance.state;
  instance.marks.made_up = static_cast<uint8_t>(catches_up ? state.transition.missed_ticks : 0);
  if (catches_up)
    state.tier = state.left_tier;
  else if (frame::is_simulated(instance.plan.decision.tier))
    state.transition.missed_ticks = 0;
}

void ride_on(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  float* off = instance.transition.tail;
  take_simulated(instance, 0, off);
  for (size_t i = 0; i < size_t{3} * instance.level->node_count(); ++i)
    off[i] = instance.transition.shown[0][i] - off[i];
  ride_rods(instance);
  state.transition.missed_ticks = 0;
  state.blend_ticks = 0;
  state.transition.rest_ticks = 0;
  state.transition.tail_rides = 1;
}

}  // namespace sinew::world
