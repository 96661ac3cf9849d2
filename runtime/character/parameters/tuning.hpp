// tuning.hpp  How parts swing, as an engine changes it between steps (sinew/parameters.hpp).
//
// Every number of a part goes to what was set as a critically damped spring does
// (character/parameters/glide.hpp): 5 % of the way are left after 12 ticks. Stiffness, in its logarithm, and
// displacement, in its root, go no faster than character/parameters/tuning.cpp says. A tick runs with the
// numbers that the end of the last one foretold, so frames between ticks know what the coming tick will have,
// and a call between steps moves nothing by itself.
//   stiffness, damping   change the recurrences of a part's modes (tissue/modes/retuned.hpp), and a rod's
//   joints
//                        (RodBatch::set_joint); q, r and l go on from where they are
//   intensity            scales what is shown, and a rod's turns; what swings is not scaled
//   displacement         scales the guard's limit
//   off                  a part that is disabled and has faded sleeps until it is enabled, and then begins at
//                        rest under its load, unseen at first
// A network corrects a part by less the further its stiffness and damping are from the baked ones, and by
// nothing from a quarter on. The bound of tissue/modes/correction_budget.hpp is of recurrences that stay:
// while they glide S may rise above it by what the change itself does; no correction is taken while it is
// above, and S falls at the modes' pace.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// ---- setting ----

// After one of the instance's SetParameters was changed, or ParameterMarks::all. True where it is tuned from
// now on: what is shown between ticks is then bounded otherwise, and is to be published again.
bool notice_parameters(Instance& instance) noexcept;

// ---- in a step ----

// A tick begins: it has what was foretold. Before its motion is followed.
void begin_tuned_tick(Instance& instance) noexcept;
// It is over and shown: foretells the next.
void end_tuned_tick(Instance& instance) noexcept;
// At once as set, where nothing of it is simulated yet.
void settle_tuning(Instance& instance) noexcept;
// Makes anew what follows from the state: after a restore, a change of level.
void retune_all(Instance& instance) noexcept;
// Nothing is on its way and no gust blows.
inline bool tuning_stands(const Instance& instance) noexcept { return instance.state->parameters.moves == 0; }

// ---- what its targets say ----

// Nothing of it is on.
bool all_is_off(const Instance& instance) noexcept;
// By how much further than Asset::reach_m what is shown may get.
float tuned_reach_m(const Instance& instance) noexcept;

}  // namespace sinew::world
