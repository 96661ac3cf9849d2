// triangle_distance.hpp  How far a place is from a triangle.
#pragma once
#include "baker/import/character.hpp"

namespace sinew::baker {

double distance_to_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace sinew::baker
