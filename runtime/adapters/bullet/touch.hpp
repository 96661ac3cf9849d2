// touch.hpp  A probe's capsule on its way past a shape: when it first touches, and where it then lies on it.
#pragma once
#include <limits>
#include <span>

#include "adapters/bullet/convex.hpp"
#include "adapters/bullet/moving_place.hpp"

namespace sinew::bullet {

// A capsule's axis through a tick, in Bullet's world; its ends go straight.
struct Path {
  Vector start[2], end[2];
  double radius_m;

  Vector at(double time, size_t which) const noexcept {
    return rods::between(start[which], end[which], time);
  }
  // No two points of axis and body near each other by more in a whole tick.
  double closing_m(const Motion& body) const noexcept;
};

struct Axis {
  Vector from, to;

  Vector at(double share) const noexcept { return rods::between(from, to, share); }
  double length() const noexcept { return rods::length(rods::difference(to, from)); }
};
inline Axis own_axis(const Path& path, double time, const Place& place) noexcept {
  return {place.own_point(path.at(time, 0)), place.own_point(path.at(time, 1))};
}

// A point of the axis, and how far it is from the shape.
struct Near {
  double share;
  Distance distance;
};
inline constexpr double kEverywhere = std::numeric_limits<double>::infinity();
// The nearest point, to `exact_m` in distance. Of an axis that lies flat: any. Where all of it is further
// away than `beyond_m`: some point of it.
Near nearest(const Convex& shape, const Axis& axis, double exact_m, double beyond_m = kEverywhere) noexcept;

// The first moment at which surfaces touch, by conservative advancement; where they do not, that of the
// moments looked at when they were nearest. `closing_m` is the path's; what starts further away than that and
// `reach_m` is looked at once.
struct Touch {
  double time;  // share of the tick
  Near near;
};
Touch first_touch(const Convex& shape, const Place& part, const Motion& body, const Path& path,
                  double closing_m, double reach_m) noexcept;

// Points that carry an axis that is as near as `near`: both ends of where it lies flat, and what of its own
// ends is within `reach_m` of touching. At most 4.
size_t supports(const Convex& shape, const Axis& axis, const Near& near, double radius_m, double reach_m,
                std::span<Near, 4> out) noexcept;

// The same on a triangle's face, seen from one side (1: where its winding is counter-clockwise); heights are
// negative behind it. None where no part of the axis is above the face. At most 2.
size_t face_supports(const Triangle& triangle, double side, const Axis& axis, double radius_m, double reach_m,
                     std::span<Near, 2> out) noexcept;

}  // namespace sinew::bullet
