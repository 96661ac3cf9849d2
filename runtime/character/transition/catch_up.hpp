// catch_up.hpp  A tick or two without simulation, made up for.
//
// What was left alone for at most kCaughtUpTicks is simulated through them when it comes back, by the poses
// of those steps, and contacts of this one: its state is then what it would have been, as far as three poses
// tell the way between them. What was shown meanwhile was carried on by itself; how far that is off rides on
// what is simulated and is faded out over kBlendInTicks or more (character/transition/blend_pace.hpp;
// inertialisation: Bollo, "Inertialization: High-Performance Animation Transitions in Gears of War", GDC
// 2018). Costs as many ticks more.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// As simulation is left, and of each tick that goes by without it.
void begin_gap(Instance& instance) noexcept;
void miss_tick(Instance& instance) noexcept;

// That it can make up for in its next step, 0: none, or too many.
uint32_t missed_so_far(const Instance& instance) noexcept;
// With the plan as it is: all of them, on the level that it has or a coarser one, by poses that are known.
// Frames much shorter than a tick leave no pose of a missed one.
bool catches_up(const Instance& instance) noexcept;
// A finer level that is planned waits for the next step, in which it is planned anew: this one has the tier
// that it left. Returns whether it waits.
bool catch_up_first(Instance& instance) noexcept;
// Before a step's tier is entered, with what catches_up said as the step began: takes the instance back to
// the tier that it left, if it catches up. Then its missed ticks have to be simulated before those of the
// step, and ride_on called.
void end_gap(Instance& instance, bool catches_up) noexcept;
// Of the last one missed: what is shown rides on what is simulated.
void ride_on(Instance& instance) noexcept;

}  // namespace sinew::world
