// step_base.hpp  The modal base of a tick: what it hears, and what it answers.
#pragma once
#include "character/tissue/region_part.hpp"

namespace sinew::world {

// theta that turns e: of the modal base alone, so that it hears nothing of what a network corrects while the
// frames do not turn (tissue/modes/correction_budget.hpp). Overwrites carry and region[0].
const float* theta_of_base(Instance& instance, const Part& part) noexcept;

// q_hat, r_hat and l_hat; felt is then e. False where they are not finite.
bool step_base(Instance& instance) noexcept;

}  // namespace sinew::world
