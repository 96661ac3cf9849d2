// fold.hpp  After a step's tasks: what they took and what they bought, into costs and the report.
#pragma once
#include "world/world_state.hpp"

namespace sinew::world {

// On the stepping thread, in slot order, so that sums do not depend on who ran when.
void fold_results(WorldState& world, FrameReport& report) noexcept;

}  // namespace sinew::world
