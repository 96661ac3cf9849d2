// push_surface.hpp  Vertices that are still inside of what they touched, pushed out where they are shown.
//
// They lie between nodes, in parts that their modes do not move, or where the press of others, or their own
// push, brought them. The push is of the picture, not of the
// tissue; it is kept for the frames that have no tick. No vertex goes further than its region's displacement
// limit.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// After show_tick: uses up instance.touches, and tells what contacts did in the tick.
void push_surface(Instance& instance) noexcept;
void forget_pushes(Instance& instance) noexcept;

}  // namespace sinew::world
