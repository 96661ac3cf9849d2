// primitives_pack.hpp  Primitives and tangents of a character to its pack.
#pragma once
#include "baker/import/character/character.hpp"
#include "baker/pack/pack_writer.hpp"

namespace sinew::baker {

// Section kPrimitives. A character that was made and not imported has one, of its one mesh.
void add_primitives(const Character& character, PackWriter& pack);

// Section kTangents; none where the character has none.
void add_tangents(const Character& character, PackWriter& pack);

}  // namespace sinew::baker
