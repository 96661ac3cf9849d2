// skip_pose.cpp  see skip_pose.hpp.
#include "world/step/skip_pose.hpp"

#include <algorithm>

#include "character/tier_limit.hpp"

namespace sinew::world {

double own_step_s(const WorldState& world, const InstanceState& state) noexcept {
  return static_cast<double>(state.poses.time_scale) * world.dt_s + state.poses.without_pose_s;
}

frame::TickPlan own_ticks(const WorldState& world, const PlanRow& row, frame::TickPlans& plans) noexcept {
  if (row.waited_for_pose)
    return frame::plan_ticks(row.remainder_s, own_step_s(world, *row.state), row.asset->tick_s,
                             world.def.max_ticks_per_step);
  return plans.of(row.remainder_s, row.asset->tick_s,
                  row.scaled ? static_cast<double>(row.state->poses.time_scale) : 1);
}

void wait_for_pose(Instance& instance, double frame_s) noexcept {
  InstanceState& state = *instance.state;
  const auto dt_s = static_cast<float>(frame_s);
  instance.marks.entered = instance.marks.changed_level = instance.marks.refined = false;
  instance.marks.cut = instance.marks.held = instance.marks.restarted = instance.marks.fell_back =
      instance.marks.came_back = false;
  instance.times = {};
  instance.plan.decision.cost_us = 0;
  instance.marks.passed = true;
  state.poses.without_pose_s += static_cast<double>(state.poses.time_scale) * frame_s;
  state.poses.skips_pose = 0;
  state.waited_s = waited_after(state, dt_s);
  state.held_s += dt_s;
  state.turn_left_s = std::max(0.0f, state.turn_left_s - dt_s);
}

void forget_skipped(InstanceState& state) noexcept {
  state.poses.skips_pose = 0;
  state.poses.without_pose_s = 0;
}

}  // namespace sinew::world
