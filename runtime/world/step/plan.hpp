// plan.hpp  What a step will do with each instance, before any of it is done.
#pragma once
#include <span>

#include "schedule/scheduler.hpp"
#include "world/world_state.hpp"

namespace sinew::world {

bool costs_are_measured(const WorldState& world) noexcept;

// Fronts at what tiers cost now, then a tier for each visible instance, then who runs in which order: those
// that were cut in the last step, then what matters most, then what is only displaced; what is idle in chunks
// behind them. Fills world.planning and world.order.
frame::ScheduleResult plan_step(WorldState& world, double dt_s) noexcept;

}  // namespace sinew::world
