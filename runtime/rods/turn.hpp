// turn.hpp  Rotations in double, x y z w, where a batch meets the world.
#pragma once
#include <array>
#include <cmath>

namespace sinew::rods {

using Vector = std::array<double, 3>;
using Turn = std::array<double, 4>;  // a quaternion

inline Vector vector_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }
inline Turn turn_of(const float (&q)[4]) { return {q[0], q[1], q[2], q[3]}; }

inline double norm(const Turn& q) { return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]); }

inline Turn normalised(const Turn& q) {
  const double length = norm(q);
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

inline Turn conjugate(const Turn& q) { return {-q[0], -q[1], -q[2], q[3]}; }

inline Turn product(const Turn& a, const Turn& b) {
  return {a[3] * b[0] + b[3] * a[0] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] + b[3] * a[1] + a[2] * b[0] - a[0] * b[2],
          a[3] * b[2] + b[3] * a[2] + a[0] * b[1] - a[1] * b[0],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

inline Vector turned(const Turn& q, const Vector& v) {
  const Turn out = product(product(q, {v[0], v[1], v[2], 0}), conjugate(q));
  return {out[0], out[1], out[2]};
}
inline Vector turned_back(const Turn& q, const Vector& v) { return turned(conjugate(q), v); }

}  // namespace sinew::rods
