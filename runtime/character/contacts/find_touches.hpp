// find_touches.hpp  What soft parts touch at the present tick, as the instance's contact source has it, and
// of its own body.
//
// Both are asked in three steps, the next only where the one before touched: a sphere around the soft
// part, one around each node's patch of surface, each vertex of such patches.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Of one region, where tissue has moved as if nothing were there; added to instance.touches, which are the
// tick's. instance.flesh: displacement along the axes of the flesh.
void find_touches(Instance& instance, uint32_t region) noexcept;

// After show_tick, of all regions, added likewise: what the press brought against something. Asked are
// vertices that touched nothing, on their way to where they are shown.
void find_late_touches(Instance& instance) noexcept;
// Of vertices that touch something: what their pushes brought them against, on their way from where they
// were shown.
void find_pushed_touches(Instance& instance) noexcept;
// There are none of either kind: in the tick neither nodes nor what they touch moved by more than
// kHardlyMoved of the region's radius, and what is not inside of anything hardly gets there.
bool touches_stand_still(const Instance& instance) noexcept;

}  // namespace sinew::world
