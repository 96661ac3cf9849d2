// hidden.hpp  Instances that nobody sees: nothing is done for them but to count the ticks that go by.
// They are counted in the plan's row (world/step/plan_row.hpp): what is hidden is not looked at.
//
// What is read of one is what it showed last. When it is seen again, the pose set then counts as having been
// held: how it got there is not known, and tissue feels nothing of it. How fast it moves is known a step
// later, and simulation begins then. The displacement it had is carried on and faded as if it had been
// extrapolated meanwhile (kCarryTicks, TransitionClock::fade_ticks), and simulation is blended in
// (character/transition/blend.hpp) over kBlendInTicks or more (character/transition/blend_pace.hpp), with a
// network's memory only if it missed no more than kRememberedTicks.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Of one that was seen until now.
void hide(Instance& instance) noexcept;
// Before its step, of an instance that was passed by.
void come_back(Instance& instance) noexcept;

}  // namespace sinew::world
