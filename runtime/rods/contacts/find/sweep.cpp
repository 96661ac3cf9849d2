// sweep.cpp  Closest points of segments, and conservative advancement of them.
#include "rods/contacts/find/sweep.hpp"

#include <algorithm>

#include "kernels/rod_contacts/rod_touch_job.hpp"

namespace sinew::rods {
namespace {

// What looks at a strand a lane goes by the same.
using simd::kRodMeeting, simd::kRodNoLength2, simd::kRodParallel, simd::kRodTouching;
constexpr double kKnownWay = 0.1;  // of a unit vector, that which is across an axis

Axis at(const Sweep& s, double time) {
  return {between(s.start.from, s.end.from, time), between(s.start.to, s.end.to, time)};
}

Vector at(const Axis& axis, double share) { return between(axis.from, axis.to, share); }

// No two points of the sweeps near each other faster, in metres a step.
double closing_speed(const Sweep& a, const Sweep& b) {
  const Vector of_a[2] = {difference(a.end.from, a.start.from), difference(a.end.to, a.start.to)};
  const Vector of_b[2] = {difference(b.end.from, b.start.from), difference(b.end.to, b.start.to)};
  double fastest = 0;
  for (const Vector& u : of_a) {
    for (const Vector& v : of_b) fastest = std::max(fastest, length(difference(u, v)));
  }
  return fastest;
}

// Some unit vector across v.
Vector any_across(const Vector& v) {
  const size_t least = std::fabs(v[0]) <= std::fabs(v[1]) && std::fabs(v[0]) <= std::fabs(v[2]) ? 0
                       : std::fabs(v[1]) <= std::fabs(v[2])                                     ? 1
                                                                                                : 2;
  Vector axis = {};
  axis[least] = 1;
  const Vector n = dot(v, v) > kRodNoLength2 ? cross(v, axis) : axis;
  return scaled(1 / length(n), n);
}

// Of axes that meet: across both, against a's way relative to b.
Vector normal_of_meeting(const Axis& a, const Axis& b, const Vector& way) {
  const Vector u = difference(a.to, a.from), v = difference(b.to, b.from), n = cross(u, v);
  const double size = length(n);
  const bool crossing = size * size > kRodParallel * dot(u, u) * dot(v, v) && size * size > kRodNoLength2;
  const Vector unit = crossing ? scaled(1 / size, n) : any_across(dot(u, u) > dot(v, v) ? u : v);
  return dot(unit, way) > 0 ? scaled(-1, unit) : unit;
}

Touch touch_at(const Sweep& a, const Sweep& b, double time) {
  const Axis now_a = at(a, time), now_b = at(b, time);
  const Nearest n = nearest(now_a, now_b);
  const Vector apart = difference(at(now_a, n.a), at(now_b, n.b));
  const double distance = length(apart), sum_m = a.radius_m + b.radius_m;
  Vector normal = scaled(1 / distance, apart);
  if (!(distance > kRodMeeting * sum_m)) {
    const Vector way_a = difference(at(a.end, n.a), at(a.start, n.a));
    normal = normal_of_meeting(now_a, now_b, difference(way_a, difference(at(b.end, n.b), at(b.start, n.b))));
  }
  return {time, n, normal, distance - sum_m, now_a, now_b};
}

}  // namespace

Vector way_out(const Axis& a, const Axis& b, const Vector& normal) noexcept {
  const Vector along = difference(a.to, a.from);
  const Vector v = across(normal, scaled(1 / length(along), along));
  const double size = length(v);
  return size > kKnownWay ? scaled(1 / size, v) : normal_of_meeting(a, b, {});
}

double nearest(const Axis& axis, const Vector& point) noexcept {
  const Vector d = difference(axis.to, axis.from);
  const double square = dot(d, d);
  return square > kRodNoLength2 ? std::clamp(dot(difference(point, axis.from), d) / square, 0.0, 1.0) : 0.0;
}

Nearest nearest(const Axis& a, const Axis& b) noexcept {
  const Vector u = difference(a.to, a.from), v = difference(b.to, b.from), r = difference(a.from, b.from);
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
  if (!(uu > kRodNoLength2)) return {0, nearest(b, a.from)};
  if (!(vv > kRodNoLength2)) return {nearest(a, b.from), 0};
  const double ur = dot(u, r), vr = dot(v, r), sine = uu * vv - uv * uv;
  double s;
  if (sine > kRodParallel * uu * vv) {
    s = std::clamp((uv * vr - ur * vv) / sine, 0.0, 1.0);
  } else {
    const double begin = nearest(a, b.from), end = nearest(a, b.to);
    s = 0.5 * (begin + end);
  }
  const double t = std::clamp((uv * s + vr) / vv, 0.0, 1.0);
  return {nearest(a, at(b, t)), t};
}

Touch first_touch(const Sweep& a, const Sweep& b, int moments) noexcept {
  const double speed = closing_speed(a, b), enough = kRodTouching * (a.radius_m + b.radius_m);
  Touch best = touch_at(a, b, 0), now = best;
  for (int k = 1; k < moments && now.gap_m > enough && now.time < 1; ++k) {
    const double next = now.gap_m >= speed * (1 - now.time) ? 1.0 : now.time + now.gap_m / speed;
    now = touch_at(a, b, std::min(next, 1.0));
    if (now.gap_m < best.gap_m) best = now;
  }
  return best;
}

}  // namespace sinew::rods
