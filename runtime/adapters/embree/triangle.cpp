// triangle.cpp  Closest points by regions, and conservative advancement.
#include "adapters/embree/triangle.hpp"

#include <algorithm>
#include <limits>

#include "rods/vector.hpp"

namespace sinew::embree {
namespace {

using namespace rods;

constexpr int kMoments = 64;
constexpr double kTouching = 1e-2, kTouchingWay = 1e-4;  // gap over the radius, over the tick's way
constexpr double kMeeting = 1e-9;                        // m: a distance without a direction

OnTriangle on_edge(const Triangle& t, uint32_t edge, double share) {
  const uint32_t next = (edge + 1) % 3;
  OnTriangle out = {between(t.corners[edge], t.corners[next], share), {}, kEdge + edge};
  out.weights[edge] = 1 - share, out.weights[next] = share;
  if (share <= 0) out.feature = kCorner + edge;
  if (share >= 1) out.feature = kCorner + next;
  return out;
}

OnTriangle on_nearest_edge(const Triangle& t, const Vector& point) {
  OnTriangle best = {};
  double least = 0;
  for (uint32_t k = 0; k < 3; ++k) {
    const OnTriangle on = on_edge(t, k, rods::nearest({t.corners[k], t.corners[(k + 1) % 3]}, point));
    const Vector apart = difference(point, on.point);
    const double square = dot(apart, apart);
    if (k == 0 || square < least) best = on, least = square;
  }
  return best;
}

Triangle at(const MovingTriangle& m, double time) {
  Triangle out;
  for (size_t k = 0; k < 3; ++k) out.corners[k] = scaled_sum(time, m.moves[k], m.start.corners[k]);
  return out;
}

Axis at(const Sweep& s, double time) {
  return {between(s.start.from, s.end.from, time), between(s.start.to, s.end.to, time)};
}

void take_nearer(double along, const OnTriangle& on, const Vector& point, AxisOnTriangle* best) {
  const double distance = length(difference(point, on.point));
  if (distance < best->distance_m) *best = {along, on, distance};
}

// Where a point's foot on the plane is in the face; edges are looked at elsewhere.
void look_at_face(const Triangle& t, const Axis& axis, double along, AxisOnTriangle* best) {
  const Vector point = between(axis.from, axis.to, along);
  const Vector ab = difference(t.corners[1], t.corners[0]), ac = difference(t.corners[2], t.corners[0]);
  const Vector ap = difference(point, t.corners[0]), n = cross(ab, ac);
  const double nn = dot(n, n), v = dot(cross(ap, ac), n), w = dot(cross(ab, ap), n);
  if (!(v > 0 && w > 0 && v + w < nn)) return;
  const double vs = v / nn, ws = w / nn;
  take_nearer(along, {scaled_sum(vs, ab, scaled_sum(ws, ac, t.corners[0])), {1 - vs - ws, vs, ws}, kFace},
              point, best);
}

// The most that what the two have between them along n, from the triangle to the axis, shrinks in a tick.
double closing_along(const Sweep& s, const MovingTriangle& m, const Vector& n) {
  const double axis =
      std::min(dot(n, difference(s.end.from, s.start.from)), dot(n, difference(s.end.to, s.start.to)));
  return std::max({dot(n, m.moves[0]), dot(n, m.moves[1]), dot(n, m.moves[2])}) - axis;
}

}  // namespace

OnTriangle nearest(const Triangle& t, const Vector& point) noexcept {
  const Vector &a = t.corners[0], &b = t.corners[1], &c = t.corners[2];
  const Vector ab = difference(b, a), ac = difference(c, a), ap = difference(point, a);
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, {1, 0, 0}, kCorner};
  const Vector bp = difference(point, b), cp = difference(point, c);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d3 >= 0 && d4 <= d3) return {b, {0, 1, 0}, kCorner + 1};
  if (d6 >= 0 && d5 <= d6) return {c, {0, 0, 1}, kCorner + 2};
  const double u = d3 * d6 - d5 * d4, v = d5 * d2 - d1 * d6, w = d1 * d4 - d3 * d2, sum = u + v + w;
  if (!(u > 0 && v > 0 && w > 0)) return on_nearest_edge(t, point);
  const double vs = v / sum, ws = w / sum;
  return {scaled_sum(vs, ab, scaled_sum(ws, ac, a)), {1 - vs - ws, vs, ws}, kFace};
}

AxisOnTriangle nearest(const Triangle& t, const Axis& axis) noexcept {
  const Vector way = difference(axis.to, axis.from);
  AxisOnTriangle best = {0, {}, std::numeric_limits<double>::infinity()};
  if (!(dot(way, way) > 0)) {
    take_nearer(0, nearest(t, axis.from), axis.from, &best);
    return best;
  }
  look_at_face(t, axis, 0, &best);
  look_at_face(t, axis, 1, &best);
  const Vector n = cross(difference(t.corners[1], t.corners[0]), difference(t.corners[2], t.corners[0]));
  const double from = dot(difference(axis.from, t.corners[0]), n);
  const double to = dot(difference(axis.to, t.corners[0]), n);
  if (from * to < 0) look_at_face(t, axis, from / (from - to), &best);
  for (uint32_t k = 0; k < 3; ++k) {
    const Nearest at = rods::nearest(axis, Axis{t.corners[k], t.corners[(k + 1) % 3]});
    take_nearer(at.a, on_edge(t, k, at.b), between(axis.from, axis.to, at.a), &best);
  }
  return best;
}

double closing_speed(const Sweep& s, const MovingTriangle& t) noexcept {
  double fastest = 0;
  for (const Vector& end : {difference(s.end.from, s.start.from), difference(s.end.to, s.start.to)}) {
    for (const Vector& move : t.moves) {
      const Vector relative = difference(end, move);
      fastest = std::max(fastest, dot(relative, relative));
    }
  }
  return std::sqrt(fastest);
}

// Both are convex: along the direction between their nearest points they come no nearer than they close.
TriangleTouch first_touch(const Sweep& sweep, const MovingTriangle& triangle) noexcept {
  const double enough = kTouching * sweep.radius_m + kTouchingWay * closing_speed(sweep, triangle);
  TriangleTouch best = {};
  double time = 0;
  for (int k = 0; k < kMoments; ++k) {
    const Axis axis = at(sweep, time);
    const AxisOnTriangle n = nearest(at(triangle, time), axis);
    const double gap = n.distance_m - sweep.radius_m;
    const Vector apart = difference(between(axis.from, axis.to, n.along), n.on.point);
    const Vector normal = n.distance_m > kMeeting ? scaled(1 / n.distance_m, apart) : Vector{};
    const double closing = closing_along(sweep, triangle, normal);
    const double arrives = closing > 0 ? time + std::max(gap, 0.0) / closing : time;
    if (k == 0 || gap < best.gap_m) best = {time, n, normal, gap, gap <= enough, arrives};
    if (!(gap > enough) || !(time < 1) || !(closing > 0)) break;
    time = std::min(1.0, time + gap / closing);
  }
  return best;
}

}  // namespace sinew::embree
