// crossed_capsules.hpp  Capsules that an animation takes a rod through.
#pragma once
#include "baker/mesh/rods/proxies.hpp"
#include "baker/mesh/rods/rods.hpp"

namespace sinew::baker {

// Removes fitted capsules, with a note, that a clip's own pose leads a rod's bone into, deeper than in the
// bind pose: the rod would hang on what its animator let it pass. Capsules whose radius the recipe states
// stay.
void drop_crossed(Character& character, const std::vector<Rod>& rods, const Recipe& recipe,
                  std::vector<Proxy>& proxies);

}  // namespace sinew::baker
