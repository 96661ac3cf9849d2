// skip_pose.hpp  Steps in which an instance has no new pose: World::skip_pose.
//
// Such a step does nothing with it, and its time goes to the step with the next pose, whose ticks then follow
// the path between the two poses as they do where frames are that long (character/motion/pose.hpp). What is
// shown waits with the pose. A step with neither pose nor skip_pose holds the pose for all of that time.
#pragma once
#include "world/world_state.hpp"

namespace sinew::world {

// Of the coming step, of its own time.
double own_step_s(const WorldState& world, const InstanceState& state) noexcept;
// Its ticks; `plans` are of steps without what was skipped.
frame::TickPlan own_ticks(const WorldState& world, const PlanRow& row, frame::TickPlans& plans) noexcept;

// In the place of a step: of one in view.
void wait_for_pose(Instance& instance, double frame_s) noexcept;
// Of a pose that came, or was held after all.
void forget_skipped(InstanceState& state) noexcept;

}  // namespace sinew::world
