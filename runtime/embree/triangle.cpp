// triangle.cpp  Closest points by regions, and conservative advancement.
#include "embree/triangle.hpp"

#include <algorithm>

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

void take_nearer(const AxisOnTriangle& candidate, AxisOnTriangle* best) {
  if (candidate.distance_m < best->distance_m) *best = candidate;
}

AxisOnTriangle at_point(const Triangle& t, const Axis& axis, double along) {
  const Vector point = between(axis.from, axis.to, along);
  const OnTriangle on = nearest(t, point);
  return {along, on, length(difference(point, on.point))};
}

AxisOnTriangle at_edge(const Triangle& t, const Axis& axis, uint32_t edge) {
  const Nearest n = rods::nearest(axis, Axis{t.corners[edge], t.corners[(edge + 1) % 3]});
  const OnTriangle on = on_edge(t, edge, n.b);
  return {n.a, on, length(difference(between(axis.from, axis.to, n.a), on.point))};
}

}  // namespace

OnTriangle nearest(const Triangle& t, const Vector& point) noexcept {
  const Vector ab = difference(t.corners[1], t.corners[0]), ac = difference(t.corners[2], t.corners[0]);
  const Vector n = cross(ab, ac), ap = difference(point, t.corners[0]);
  const double nn = dot(n, n);
  if (!(nn > 0)) return on_nearest_edge(t, point);
  // Areas over the triangle's, of the point's foot on its plane.
  const double v = dot(cross(ap, ac), n) / nn, w = dot(cross(ab, ap), n) / nn, u = 1 - v - w;
  if (!(u > 0 && v > 0 && w > 0)) return on_nearest_edge(t, point);
  return {scaled_sum(v, ab, scaled_sum(w, ac, t.corners[0])), {u, v, w}, kFace};
}

AxisOnTriangle nearest(const Triangle& t, const Axis& axis) noexcept {
  AxisOnTriangle best = at_point(t, axis, 0);
  const Vector way = difference(axis.to, axis.from);
  if (!(dot(way, way) > 0)) return best;
  take_nearer(at_point(t, axis, 1), &best);
  const Vector n = cross(difference(t.corners[1], t.corners[0]), difference(t.corners[2], t.corners[0]));
  const double from = dot(difference(axis.from, t.corners[0]), n);
  const double to = dot(difference(axis.to, t.corners[0]), n);
  if (from * to < 0) take_nearer(at_point(t, axis, from / (from - to)), &best);
  for (uint32_t k = 0; k < 3; ++k) take_nearer(at_edge(t, axis, k), &best);
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

TriangleTouch first_touch(const Sweep& sweep, const MovingTriangle& triangle) noexcept {
  const double speed = closing_speed(sweep, triangle);
  const double enough = kTouching * sweep.radius_m + kTouchingWay * speed;
  TriangleTouch best = {};
  double time = 0;
  for (int k = 0; k < kMoments; ++k) {
    const AxisOnTriangle n = nearest(at(triangle, time), at(sweep, time));
    const double gap = n.distance_m - sweep.radius_m;
    if (k == 0 || gap < best.gap_m) best = {time, n, {}, gap};
    if (!(gap > enough) || !(time < 1) || gap >= speed) break;
    time = std::min(1.0, gap >= speed * (1 - time) ? 1.0 : time + gap / speed);
  }
  const Axis axis = at(sweep, best.time);
  const Vector apart = difference(between(axis.from, axis.to, best.at.along), best.at.on.point);
  if (best.at.distance_m > kMeeting) best.normal = scaled(1 / best.at.distance_m, apart);
  return best;
}

}  // namespace sinew::embree
