// stiffness.hpp  How stiff a character's skin is: painted, or as regions that name bones state it.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/recipe.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

struct Stiffness {
  std::vector<double> of_vertex;  // 0 soft .. 1 rigid, equal for welded vertices
  std::vector<int> region;        // whose it is where it is not rigid; -1: nobody's, as where it is painted
  std::vector<int>
      piece;  // of a region that names pieces: what stays one part; -1 elsewhere; empty: none does
};

Stiffness painted_stiffness(const Character& character);

// Regions do not touch: where they meet the skin is held. coreless: joints whose flesh is soft whatever its
// thickness. Pieces that are fastened to one bone are soft in a region that names them, and in one of bones
// that has nothing else. Throws BadInput as scope_of does.
Stiffness stated_stiffness(const Character& character, const Surface& surface,
                           const std::vector<RegionRecipe>& regions, const std::vector<bool>& coreless);

}  // namespace sinew::baker
