// sweep.hpp  Two capsules on their way through a step: where and when they first touch.
#pragma once
#include "rods/vector.hpp"
#include "sinew/export.h"

namespace sinew::rods {

struct Axis {
  Vector from, to;  // equal: a point
};

// A capsule from the step's start to its end; in between its axis' ends go straight.
struct Sweep {
  Axis start, end;
  double radius_m;
};

// Points of two axes, as shares of their lengths, that are nearest to each other (Ericson 2005, 5.1.9). Of
// parallel ones the middle of where they lie side by side; axes of no length are points.
// SINEW_API: the adapters ask, too.
struct Nearest {
  double a, b;
};
SINEW_API Nearest nearest(const Axis& a, const Axis& b) noexcept;

// The share of `axis` nearest to a point.
SINEW_API double nearest(const Axis& axis, const Vector& point) noexcept;

// A direction out of b for an axis a that lies deep in it: across a, and across b where they cross.
Vector way_out(const Axis& a, const Axis& b, const Vector& normal) noexcept;

// When two sweeps first touch, or, where they do not, are nearest of the moments looked at: by conservative
// advancement, at most `moments` of them.
struct Touch {
  double time;          // share of the step
  Nearest at;           // of the axes then
  Vector normal;        // from b to a; across both where the axes meet
  double gap_m;         // then, between the surfaces
  Axis axis_a, axis_b;  // then
};
Touch first_touch(const Sweep& a, const Sweep& b, int moments = 32) noexcept;

}  // namespace sinew::rods
