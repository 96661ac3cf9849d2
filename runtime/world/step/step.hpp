// step.hpp  One step of the world: plan, schedule, run, report.
#pragma once
#include "world/world_state.hpp"

namespace sinew::world {

FrameReport step(WorldState& world, float dt_s) noexcept;

}  // namespace sinew::world
