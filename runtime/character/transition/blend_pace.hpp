// blend_pace.hpp  How fast simulation is blended in.
//
// A blend takes kBlendInTicks. To what began at rest, which swings on for longer where it began elsewhere
// than it would have been, it takes up to kLongestBlendTicks by how far it moves a node in a tick; one that
// began from what was shown ends half as fast where something moves. Where it would move a node further in a
// tick than simulation itself does by more than a share of the character's height, it goes on by less than a
// tick: at least by so much that it is over after kLongestBlendTicks. How far that is is found anew in every
// tick, by the tail and simulation as they then are: a landing in the midst of a blend, or what is still on
// its way from an earlier one, counts.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Within a tick, with what is simulated in shown[0] and what was shown last in shown[1]: takes blend_ticks
// on.
void advance_blend(Instance& instance) noexcept;

}  // namespace sinew::world
