// press_region.hpp  Touches of one soft part as forces within the tick.
//
// The deepest vertex of a patch is its node's contact, along the mean of what touches on its side; all of a
// part's are solved together (tissue/modes/contact_response.hpp), and base and network hear of it. No
// node is asked to go beyond nine tenths of its region's displacement limit, where the guard holds it. A part
// that touches something does not sleep.
#pragma once
#include <span>

#include "character/instance.hpp"

namespace sinew::world {

void press_region(Instance& instance, uint32_t region, std::span<const Touch> touches) noexcept;

}  // namespace sinew::world
