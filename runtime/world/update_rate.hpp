// update_rate.hpp  Which ticks are simulated whole, where an instance is given fewer than all.
//
// Simulated every n ticks (InstanceState::every), a tick in between follows no poses: modes and springs go on
// by what they heard last. When the n-th comes, k ticks after the one before it:
//   - accelerations and turns are differences over k ticks; where the spacing has changed, the step before is
//     taken as if it had lasted as long, so that a difference of velocities stays one
//   - what was heard is taken to have grown evenly over the k ticks: q and r, or a spring's u, become what
//   they
//     had been (tissue::ramp), and this tick goes on from there
// State is always that of the last two ticks, whatever n: a change of n needs nothing. Instances take turns,
// by when they were made. With n = 1 the bits are those of a world without any of this.
#pragma once
#include "world/instance.hpp"

namespace sinew::world {

enum class HeardBy : uint32_t { kNobody = 0, kSprings = 1, kModes = 2 };
HeardBy hearer(Tier tier) noexcept;  // of a simulated tier

// n of this instance: 1 on networks, and with what is touched or swings tick by tick, contacts and rods.
uint32_t every_of(const Instance& instance) noexcept;

// Begins a tick of a simulated tier. True: it is simulated whole, and state.since_ticks says k.
bool begin_tick(Instance& instance) noexcept;
// After poses were followed: the past is spaced as the present.
void respace_past(Instance& instance) noexcept;

}  // namespace sinew::world
