// forget.hpp  What an instance has lived through, taken back.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Displacement, shown and carried on, is zero from now on; simulation would start anew.
void forget_displacement(Instance& instance) noexcept;

// Forgets motion and displacement; the next pose is taken as having been held for ever. Counters stay.
void forget_motion(Instance& instance) noexcept;

}  // namespace sinew::world
