// triangle.hpp  A triangle on its way through a tick: what of it is nearest, and when it is first touched.
#pragma once
#include <array>
#include <cstdint>

#include "rods/contacts/find/sweep.hpp"

namespace sinew::embree {

using rods::Axis;
using rods::Sweep;
using rods::Vector;

struct Triangle {
  std::array<Vector, 3> corners;
};

// What of a triangle a point lies on: corner 0, 1, 2; the edge from corner 0, 1, 2 to the next; the face.
enum Feature : uint32_t { kCorner = 0, kEdge = 3, kFace = 6 };

struct OnTriangle {
  Vector point;
  std::array<double, 3> weights;  // of the corners
  uint32_t feature;
};
// Ericson 2005, 5.1.5. A triangle without area is its edges.
OnTriangle nearest(const Triangle& triangle, const Vector& point) noexcept;

struct AxisOnTriangle {
  double along;  // share of the axis
  OnTriangle on;
  double distance_m;
};
AxisOnTriangle nearest(const Triangle& triangle, const Axis& axis) noexcept;

// Corners go straight.
struct MovingTriangle {
  Triangle start;
  std::array<Vector, 3> moves;
};

// When a sweep first touches, or, where it does not, is nearest of the moments looked at.
struct TriangleTouch {
  double time;
  AxisOnTriangle at;
  Vector normal;  // to the sweep; zero where the axis meets the triangle
  double gap_m;   // then, between the surfaces
  bool touches;
  double arrives;  // when the gap will have closed, along the normal
};
TriangleTouch first_touch(const Sweep& sweep, const MovingTriangle& triangle) noexcept;

// No points of the two near each other faster, in metres a tick.
double closing_speed(const Sweep& sweep, const MovingTriangle& triangle) noexcept;

inline Vector weighted(const std::array<Vector, 3>& corners, const std::array<double, 3>& w) {
  Vector out;
  for (size_t k = 0; k < 3; ++k) out[k] = w[0] * corners[0][k] + w[1] * corners[1][k] + w[2] * corners[2][k];
  return out;
}

}  // namespace sinew::embree
