// baked_from.hpp  What a character was baked from.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/recipe.hpp"

namespace sinew::baker {

struct BakedFrom {
  std::string glb, recipe;           // no glb: nothing is simulated or baked anew
  std::vector<std::string> weights;  // the character's own first
  std::string rods = {};             // weights that its rods start from; empty: none do
  std::string emulator = {};         // weights that predict its patches; empty: none do

  Recipe read() const { return recipe.empty() ? Recipe{} : read_recipe(recipe); }
  Character import(const Recipe& as) const;
};

}  // namespace sinew::baker
