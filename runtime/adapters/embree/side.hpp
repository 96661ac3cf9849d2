// side.hpp  On which side of a surface a point is, told at the point of the surface that is nearest to it.
#pragma once
#include "adapters/embree/surface.hpp"

namespace sinew::embree {

enum class Side { kOutside, kInside };

// By the sign of the angle-weighted pseudonormal, which is exact for closed surfaces that do not cross
// themselves (Baerentzen, Aanaes 2005). Outside: beyond a border, and by triangles that `groups` leaves out.
Side side_of(const Surface& surface, uint32_t groups, uint32_t triangle, const OnTriangle& on,
             const Vector& point) noexcept;

// Of the face, edge or corner, out of the surface; zero at a border. Not a unit vector.
Vector pseudonormal(const Surface& surface, uint32_t groups, uint32_t triangle, uint32_t feature) noexcept;

}  // namespace sinew::embree
