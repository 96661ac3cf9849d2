// creature_file.hpp  A made creature as tinygltf reads it back.
#pragma once
#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "baker/creature/creature.hpp"
#include "baker/creature/surface.hpp"

namespace sinew::test {

struct CreatureFile {
  tinygltf::Model model;
  std::string complaints;  // tinygltf's errors and warnings

  std::vector<double> numbers(int accessor) const;  // components in a row; normalised integers as 0 .. 1
  std::vector<double> attribute(size_t primitive, const std::string& name) const;
  baker::Surface surface(size_t primitive) const;
};

CreatureFile parse(const std::vector<std::byte>& bytes);

std::string recipe_path();                      // the shipped creature's
const baker::CreatureRecipe& shipped_recipe();  // read once
const CreatureFile& default_creature();         // made once, at the recipe's own size

}  // namespace sinew::test
