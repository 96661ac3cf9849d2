// tangents.hpp  Tangents of vertices for which a file states none, from where they lie in a texture.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

using Vector2 = Eigen::Vector2d;

// Takes the place of tangents that are zero: square to the normal, along growing u, weighted by the angles of
// the triangles about the vertex and of those at its place that face alike and lie at the same uv. Where
// these show the picture mirrored and upright, what has the larger angle counts. Where uv is not finite or
// not spread over a triangle: any direction square to the normal. Where no vertex has a tangent or a finite
// uv the character has no tangents. Its triangles, normals and welded are there.
void compute_missing_tangents(const std::vector<Vector2>& uv, Character& character);

}  // namespace sinew::baker
