// smooth_groups.hpp  Vertices at one place that face alike: two sides of a seam, not of a hard edge or a
// sheet.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// Vertex -> the first welded to it (Character::welded) whose normal is much the same. Where a normal is zero,
// that of its own triangles counts.
std::vector<int> smooth_groups(const Character& character);

// Of each vertex, the area vectors of its group's triangles added up; not normalised, zero where none has
// area.
std::vector<Vector3> area_vectors(const Character& character, const std::vector<int>& groups);

}  // namespace sinew::baker
