// describe_source.hpp  What is inside a glTF or VRM file, in the names that a recipe uses.
#pragma once
#include <nlohmann/json.hpp>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// Bones with how many vertices follow each most, meshes and clips.
nlohmann::ordered_json describe_source(const Character& character);

}  // namespace sinew::baker
