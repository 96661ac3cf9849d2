// import_character.hpp  A character's file, as its recipe says how to read it.
#pragma once
#include "baker/import/import_gltf.hpp"
#include "baker/mesh/recipe/recipe.hpp"

namespace sinew::baker {

// Throws BadInput as import_gltf does.
Character import_character(const std::string& path, const Recipe& recipe);

}  // namespace sinew::baker
