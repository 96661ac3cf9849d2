// region_scope.hpp  What of a character a recipe's region names: bones, a mesh, a material, an island.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/recipe.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

// Whether the region names a piece of the surface, and not bones alone.
bool selects_piece(const RegionRecipe& region);

struct RegionScope {
  std::vector<bool> joints;    // those that it names; all where it names none
  std::vector<bool> vertices;  // of the surface that it names, equal for welded ones; all where it names none
};

// An island is looked for in the mesh and material that the region names, if it does. Throws BadInput for a
// joint, mesh or material that is not there, with the names that are, for no surface near `island_at`, and
// where mesh and material have no vertex in common.
RegionScope scope_of(const Character& character, const Surface& surface, const RegionRecipe& region);

inline constexpr double kIslandReach = 0.1;  // of the height: how far from island_at its island may be

}  // namespace sinew::baker
