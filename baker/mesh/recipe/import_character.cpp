// import_character.cpp  The recipe's share of the import options.
#include "baker/mesh/recipe/import_character.hpp"

namespace sinew::baker {

Character import_character(const std::string& path, const Recipe& recipe) {
  ImportOptions options;
  options.unit_m = recipe.unit_m;
  options.up = recipe.up;
  options.without_meshes = recipe.without_meshes;
  options.with_meshes = recipe.with_meshes;
  return import_gltf(path, options);
}

}  // namespace sinew::baker
