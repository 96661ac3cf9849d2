// weld.hpp  Vertices that a seam has doubled found again, and what needs to know it.
#pragma once
#include "baker/import/character/character.hpp"
#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

// Fills character.welded: the first vertex at the same place, to a millionth of the character's longest side,
// that the same joints move, to a fiftieth of the weight. Rims of meshes that meet so are one surface.
void weld_vertices(Character& character);
// Triangles whose corners coincide or lie on a line, of the character's primitives.
void drop_degenerate_triangles(Character& character, Source& source);
// Smooth normals, weighted by area, where the character has zero ones.
void compute_missing_normals(Character& character);

}  // namespace sinew::baker
