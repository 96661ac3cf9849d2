// find_touches.hpp  What soft parts touch at the present tick, as the instance's contact source has it, and
// of its own body.
//
// Both are asked in three steps, the next only where the one before touched: a sphere around the soft
// part, one around each node's patch of surface, each vertex of such patches.
#pragma once
#include "world/instance.hpp"

namespace sinew::world {

// Of one region, where tissue has moved as if nothing were there; added to instance.touches, which are the
// tick's. instance.flesh: displacement along the axes of the flesh.
void find_touches(Instance& instance, uint32_t region) noexcept;

}  // namespace sinew::world
