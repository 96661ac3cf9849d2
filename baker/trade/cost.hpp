// cost.hpp  What a step of an instance takes: world::step_instance, which is all that World::step does for it
// but choosing its tier.
#pragma once
#include "baker/programs/closed_loop.hpp"
#include "baker/trade/row.hpp"

namespace sinew::baker {

// One thread, the thread's own time, along the motion. warm: the same instance again; of
// several passes the quickest, for a busy neighbour slows down all that share its core. Extrapolate: between
// ticks of the best tier, which do not count.
Cost warm_cost(const LoadedPack& character, const TrueMotion& motion, Tier tier, uint32_t every,
               uint32_t level);
// cold: instances enough to fill the last-level cache one and a half times, each stepped once a round.
Cost cold_cost(const LoadedPack& character, const TrueMotion& motion, Tier tier, uint32_t every,
               uint32_t level);

}  // namespace sinew::baker
