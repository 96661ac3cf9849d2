// constraints.cpp  A joint's two constraints, each a pure function: value and derivatives.
#include "rods/solver/constraints.hpp"

#include <cmath>

namespace sinew::rods {
namespace {

constexpr double kUnitTolerance = 1e-3;

bool usable(const JointEnd& e) {
  const double* q = e.orientation;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double sum = e.position_m[0] + e.position_m[1] + e.position_m[2] + e.length_m;
  return std::isfinite(sum) && e.length_m > 0 && std::fabs(length - 1) <= kUnitTolerance;
}

struct OwnAxes {
  double x[3], y[3], z[3];
};

OwnAxes axes_of(const double q[4]) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
          {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
          {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

// conj(a) b, w not negative.
void relative(const double a[4], const double b[4], double p[4]) {
  p[0] = a[3] * b[0] - b[3] * a[0] - (a[1] * b[2] - a[2] * b[1]);
  p[1] = a[3] * b[1] - b[3] * a[1] - (a[2] * b[0] - a[0] * b[2]);
  p[2] = a[3] * b[2] - b[3] * a[2] - (a[0] * b[1] - a[1] * b[0]);
  p[3] = a[3] * b[3] + a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  if (p[3] < 0) {
    for (int k = 0; k < 4; ++k) p[k] = -p[k];
  }
}

}  // namespace

bool stretch_shear(const JointEnd& parent, const JointEnd& child, Constraint* out) noexcept {
  if (!usable(parent) || !usable(child)) return false;
  const OwnAxes a = axes_of(parent.orientation), b = axes_of(child.orientation);
  const double l_a = parent.length_m / 2, l_b = child.length_m / 2;
  *out = {};
  for (int k = 0; k < 3; ++k) {
    out->value[k] = parent.position_m[k] - child.position_m[k] + l_a * a.z[k] + l_b * b.z[k];
    out->by_parent_position[k][k] = 1;
    out->by_child_position[k][k] = -1;
    out->by_parent_rotation[k][0] = -l_a * a.y[k];
    out->by_parent_rotation[k][1] = l_a * a.x[k];
    out->by_child_rotation[k][0] = -l_b * b.y[k];
    out->by_child_rotation[k][1] = l_b * b.x[k];
  }
  return true;
}

bool darboux(const JointEnd& parent, const JointEnd& child, double out[3]) noexcept {
  if (!usable(parent) || !usable(child)) return false;
  double p[4];
  relative(parent.orientation, child.orientation, p);
  for (int k = 0; k < 3; ++k) out[k] = 2 * p[k];
  return true;
}

bool bend_twist(const JointEnd& parent, const JointEnd& child, const double rest[3],
                Constraint* out) noexcept {
  if (!usable(parent) || !usable(child) || !std::isfinite(rest[0] + rest[1] + rest[2])) return false;
  double p[4];
  relative(parent.orientation, child.orientation, p);
  const double by_child[3][3] = {{p[3], -p[2], p[1]}, {p[2], p[3], -p[0]}, {-p[1], p[0], p[3]}};
  *out = {};
  for (int r = 0; r < 3; ++r) {
    out->value[r] = 2 * p[r] - rest[r];
    for (int c = 0; c < 3; ++c) {
      out->by_child_rotation[r][c] = by_child[r][c];
      out->by_parent_rotation[r][c] = -by_child[c][r];
    }
  }
  return true;
}

}  // namespace sinew::rods
