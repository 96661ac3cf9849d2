// moving_place.hpp  Where a body or a part of one is during a tick.
#pragma once
#include "rods/vector.hpp"

class btTransform;

namespace sinew::bullet {

using rods::Vector;
using Matrix = std::array<Vector, 3>;  // rows

// World from own axes.
struct Place {
  Matrix turn;
  Vector at_m;

  Vector point(const Vector& own) const noexcept;
  Vector direction(const Vector& own) const noexcept;
  Vector own_point(const Vector& point) const noexcept;
};
inline constexpr Place kHere = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
bool finite(const Place& place) noexcept;
Place place_of(const btTransform& transform) noexcept;
Place product(const Place& a, const Place& b) noexcept;

// Straight on and turning evenly.
struct Motion {
  Place start, end;
  Vector move_m, spin_rad;  // in the tick; about start.at_m

  static Motion ending_at(const Place& end, const Vector& move_m, const Vector& spin_rad) noexcept;
  // Of a part that is fixed to it, at a share of the tick.
  Place at(double time, const Place& part) const noexcept;
};

}  // namespace sinew::bullet
