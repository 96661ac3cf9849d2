// hold_roots.hpp  Chains that begin where the skeleton begins, such as hair or a whip in a file of its own.
#pragma once
#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/recipe.hpp"

namespace sinew::baker {

// A rod needs a joint that holds it. Roots of the recipe's rods, of the file's springs, and bones that are
// called like hair, cloth and other chains get one where they have none (import/character/joint_above.hpp).
void hold_roots(Character& character, const Recipe& recipe);

}  // namespace sinew::baker
