// moving_place.cpp  see moving_place.hpp.
#include "adapters/bullet/moving_place.hpp"

#include <LinearMath/btTransform.h>

namespace sinew::bullet {
namespace {

// By Rodrigues' formula.
Matrix rotation(const Vector& spin) {
  const double angle = rods::length(spin);
  if (!(angle > 1e-12)) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Vector u = rods::scaled(1 / angle, spin);
  const double c = std::cos(angle), s = std::sin(angle), k = 1 - c;
  return {{{c + k * u[0] * u[0], k * u[0] * u[1] - s * u[2], k * u[0] * u[2] + s * u[1]},
           {k * u[0] * u[1] + s * u[2], c + k * u[1] * u[1], k * u[1] * u[2] - s * u[0]},
           {k * u[0] * u[2] - s * u[1], k * u[1] * u[2] + s * u[0], c + k * u[2] * u[2]}}};
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
  }
  return out;
}

}  // namespace

bool finite(const Place& place) noexcept {
  return rods::finite(place.turn[0]) && rods::finite(place.turn[1]) && rods::finite(place.turn[2]) &&
         rods::finite(place.at_m);
}

Vector Place::direction(const Vector& own) const noexcept {
  return {rods::dot(turn[0], own), rods::dot(turn[1], own), rods::dot(turn[2], own)};
}

Vector Place::point(const Vector& own) const noexcept { return rods::sum(at_m, direction(own)); }

Vector Place::own_point(const Vector& point) const noexcept {
  const Vector d = rods::difference(point, at_m);
  return rods::sum(rods::sum(rods::scaled(d[0], turn[0]), rods::scaled(d[1], turn[1])),
                   rods::scaled(d[2], turn[2]));
}

Place place_of(const btTransform& transform) noexcept {
  Place out;
  for (int i = 0; i < 3; ++i) {
    const btVector3& row = transform.getBasis().getRow(i);
    out.turn[static_cast<size_t>(i)] = {row.x(), row.y(), row.z()};
    out.at_m[static_cast<size_t>(i)] = transform.getOrigin()[i];
  }
  return out;
}

Place product(const Place& a, const Place& b) noexcept { return {product(a.turn, b.turn), a.point(b.at_m)}; }

Motion Motion::ending_at(const Place& end, const Vector& move_m, const Vector& spin_rad) noexcept {
  const Place start = {product(rotation(rods::scaled(-1, spin_rad)), end.turn),
                       rods::difference(end.at_m, move_m)};
  return {start, end, move_m, spin_rad};
}

Place Motion::at(double time, const Place& part) const noexcept {
  if (time == 0) return product(start, part);
  if (time == 1) return product(end, part);
  const Vector spin = rods::scaled(time, spin_rad);
  const Place now = {rods::dot(spin, spin) > 0 ? product(rotation(spin), start.turn) : start.turn,
                     rods::scaled_sum(time, move_m, start.at_m)};
  return product(now, part);
}

}  // namespace sinew::bullet
