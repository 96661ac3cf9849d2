// character_mesh.hpp  An imported character in a pose, ready to be drawn.
#pragma once
#include "baker/import/character/character.hpp"
#include "baker/render/mesh.hpp"

namespace sinew::portrait {

enum class Paint { kColors, kStiffness };

// clip null: the file's rest pose. Throws BadInput when stiffness is asked for and the file paints none.
render::Mesh posed_mesh(const baker::Character& character, const baker::Clip* clip, double t_s, Paint paint);

// Throws BadInput naming the clips there are.
const baker::Clip& find_clip(const baker::Character& character, const std::string& name);

}  // namespace sinew::portrait
