// rod_sleep.hpp  Rods at rest are not stepped, as regions at rest are not (character/rest/sleep.hpp).
//
//   quiet   in a tick: no rod touches anything, every one is held and shaped as when the quiet began, within
//   the tolerance times its
//           length and in radians, and no segment turned by more than a tenth of the tolerance
//   asleep  after kRodsQuietTicks quiet ticks in a row, as long as they are held and shaped so and nothing
//           comes near (character/rods/rod_contacts.hpp)
// A tolerance of 0: never.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// In the newest of RodState::rest and hold.
bool rods_are_held_as_asleep(const Instance& instance) noexcept;
// Before a tick's drive: true where it may be left out.
bool rods_sleep_on(Instance& instance) noexcept;
// After it: counts quiet ticks.
void watch_rods(Instance& instance) noexcept;

}  // namespace sinew::world
