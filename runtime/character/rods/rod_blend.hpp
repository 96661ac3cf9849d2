// rod_blend.hpp  What rods show: simulated, carried on without simulation, and the way between, as
// character/transition/blend.hpp has it for tissue. The lengths of time are the same; turns take the place of
// displacements.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// As the pose has them.
void forget_rods(Instance& instance) noexcept;
// Simulation is left: how rods are turned is carried on.
void begin_rod_tails(Instance& instance, float velocity_kept) noexcept;
// What is shown rides on what is simulated (character/transition/catch_up.hpp).
void ride_rods(Instance& instance) noexcept;
// Simulation comes back: from how rods are shown.
void take_rods_as_shown(Instance& instance) noexcept;
// End of a tick; simulated: the share of what is simulated in what is shown.
void show_rods(Instance& instance, float simulated) noexcept;
// [slots][4] at the end of the last step; the last tick's own where it ended on that
// (character/output/between_ticks.hpp).
const float* rods_shown_now(Instance& instance) noexcept;

}  // namespace sinew::world
