// convex.hpp  How far a point is from a convex shape, in the shape's own axes.
//
// Signed distances, negative inside, are convex functions of the point; a triangle's is never negative.
#pragma once
#include "rods/vector.hpp"

class btConvexShape;
class btStaticPlaneShape;

namespace sinew::bullet {

using rods::Vector;

struct Distance {
  double m;
  Vector normal;  // unit vector out of the shape, towards the point
};

struct Triangle {
  Vector corners[3];
  double margin_m;
};

struct Convex {
  enum Kind { kSphere, kBox, kCapsule, kCylinder, kPlane, kTriangle, kOther };
  Kind kind = kSphere;
  size_t axis = 0;                  // kCapsule, kCylinder
  double radius_m = 0, half_m = 0;  // half_m: of the axis
  Vector size = {};                 // kBox, kOther: half extents; kPlane: normal, with half_m its distance
  Vector middle = {};               // kOther: of its box
  Triangle triangle = {};           // kTriangle
  const btConvexShape* other = nullptr;  // kOther: asked by GJK and, inside, EPA

  bool has_volume() const noexcept;
  // How far outside of a middle, an axis or a face its surface lies; 0 where it lies about none.
  double core_m() const noexcept;
};

Convex convex_of(const btConvexShape& shape) noexcept;
Convex convex_of(const btStaticPlaneShape& plane) noexcept;
inline Convex convex_of(const Triangle& triangle) noexcept {
  return {.kind = Convex::kTriangle, .triangle = triangle};
}

Distance distance(const Convex& shape, const Vector& point) noexcept;

// Twice the area as a vector along the normal of its winding.
Vector area(const Triangle& triangle) noexcept;
// Finite, and not a line.
bool is_triangle(const Triangle& triangle) noexcept;

}  // namespace sinew::bullet
