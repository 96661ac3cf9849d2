// anatomy_parts.hpp  Soft parts that a body has by its shape, where no name, paint or recipe says so.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/candidate.hpp"

namespace sinew::baker {

// A belly on the spine between the limbs: certain below a spine that lies, and before one that stands where
// it is deep and bulges. Buttocks and thighs of what stands upright: always in doubt, as is everything of a
// character whose meshes are named like armour or a machine. None of what a joint of `claimed` moves, and
// none without an anatomy (anatomy.hpp).
std::vector<Candidate> anatomy_parts(const Character& character, const std::vector<bool>& claimed);

}  // namespace sinew::baker
