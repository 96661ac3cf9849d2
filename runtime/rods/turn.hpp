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

// Where it turns x, y and z to.
struct Axes {
  Vector x, y, z;
};
inline Axes axes_of(const Turn& q) {
  const double xx = 2 * q[0] * q[0], yy = 2 * q[1] * q[1], zz = 2 * q[2] * q[2];
  const double xy = 2 * q[0] * q[1], xz = 2 * q[0] * q[2], yz = 2 * q[1] * q[2];
  const double xw = 2 * q[0] * q[3], yw = 2 * q[1] * q[3], zw = 2 * q[2] * q[3];
  return {{1 - yy - zz, xy + zw, xz - yw}, {xy - zw, 1 - xx - zz, yz + xw}, {xz + yw, yz - xw, 1 - xx - yy}};
}

inline Vector turned(const Turn& q, const Vector& v) {
  const Turn out = product(product(q, {v[0], v[1], v[2], 0}), conjugate(q));
  return {out[0], out[1], out[2]};
}
inline Vector turned_back(const Turn& q, const Vector& v) { return turned(conjugate(q), v); }

}  // namespace sinew::rods
