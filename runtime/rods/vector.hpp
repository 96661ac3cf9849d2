// vector.hpp  Vectors in double, where contacts are found and their forces computed.
#pragma once
#include <cmath>
#include <cstddef>

#include "rods/turn.hpp"

namespace sinew::rods {

inline Vector sum(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector scaled(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
// s a + b
inline Vector scaled_sum(double s, const Vector& a, const Vector& b) {
  return {s * a[0] + b[0], s * a[1] + b[1], s * a[2] + b[2]};
}
// a + t (b - a)
inline Vector between(const Vector& a, const Vector& b, double t) {
  return scaled_sum(t, difference(b, a), a);
}
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length(const Vector& a) { return std::sqrt(dot(a, a)); }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// What of v is across n, a unit vector.
inline Vector across(const Vector& v, const Vector& n) { return scaled_sum(-dot(v, n), n, v); }
inline bool finite(const Vector& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

}  // namespace sinew::rods
