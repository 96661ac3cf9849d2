// spend_corrections.hpp  What of a network's answer a tick takes: as much as each region's budget allows.
//
// A correction is taken to the modes, times the largest share that tissue/modes/correction_budget.hpp allows;
// what was corrected before goes on with the modes, and the budget with it, whether there is a network or
// not.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// l of this tick is the network's, as far as modes can have it and its budget lets it.
void settle_on_network(Instance& instance) noexcept;

// l of this tick is the base's.
void settle_on_base(Instance& instance) noexcept;

}  // namespace sinew::world
