// tissue_contacts.hpp  Soft parts against what the instance's contact source knows, and against its own body,
// in three parts: what touches (find_touches), what that does to the tissue (press_region), what is left of
// it at the surface (push_surface).
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// After simulate_tick: the first two.
void touch_tissue(Instance& instance) noexcept;

}  // namespace sinew::world
