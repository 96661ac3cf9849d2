// creature.hpp  Makes a character from a recipe: an implicit surface meshed, skinned, painted and animated.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "baker/creature/creature_recipe.hpp"

namespace sinew::baker {

inline constexpr size_t kFewestCreatureVertices = 200;
inline constexpr size_t kMostCreatureVertices = 50000;

// Throws BadInput: not readable, not JSON, an unknown key (named, with the nearest known one), a value
// outside its range, a joint that does not exist. assets/creature/README.md says what the keys mean.
CreatureRecipe read_creature_recipe(const std::string& path);

// A glTF 2.0 binary with about `vertices` vertices (within 10 %); 0 takes the recipe's own number. The same
// bytes on every run. Throws BadInput: vertices outside 200 .. 50000, a body that is not one closed piece
// without handles.
std::vector<std::byte> make_creature(const CreatureRecipe& recipe, size_t vertices = 0);

}  // namespace sinew::baker
