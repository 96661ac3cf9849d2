// stiffness.hpp  How stiff a character's skin is: painted, stated by a recipe's regions, or guessed from its
// flesh.
#pragma once
#include <vector>

#include "baker/import/character.hpp"
#include "baker/mesh/recipe.hpp"
#include "baker/mesh/surface.hpp"

namespace sinew::baker {

// 0 soft .. 1 rigid, equal for welded vertices. Throws BadInput for a recipe's joint that does not exist.
std::vector<double> find_stiffness(Character& character, const Surface& surface, const Recipe& recipe);

}  // namespace sinew::baker
