// fold.cpp  see fold.hpp.
#include "adapters/embree/fold.hpp"

#include <algorithm>

#include "rods/vector.hpp"

namespace sinew::embree {
namespace {

using namespace rods;

constexpr double kFlat = 1e-3;  // of the radius

Triangle at(const MovingTriangle& m, double time) {
  Triangle out;
  for (size_t k = 0; k < 3; ++k) out.corners[k] = scaled_sum(time, m.moves[k], m.start.corners[k]);
  return out;
}

// Zero where the triangle has no area, or shows its back.
Vector normal_to(const Triangle& t, const Vector& point, bool two_sided) {
  const Vector n = cross(difference(t.corners[1], t.corners[0]), difference(t.corners[2], t.corners[0]));
  const double size = length(n), height = dot(n, difference(point, t.corners[0]));
  if (!(size > 0) || (height < 0 && !two_sided)) return {};
  return scaled((height < 0 ? -1 : 1) / size, n);
}

// Above the plane of the contact that holds the point.
double highest(const Triangle& t, const HeldPoint& held) {
  const auto height = [&](const Vector& c) { return dot(held.normal, difference(c, held.start)); };
  return std::max({height(t.corners[0]), height(t.corners[1]), height(t.corners[2])}) + held.gap_m +
         held.radius_m;
}

}  // namespace

std::optional<FoldTouch> touch_in_fold(const HeldPoint& held, const MovingTriangle& triangle,
                                       bool two_sided) noexcept {
  const Triangle& t = triangle.start;
  const double radius = held.radius_m, deep = kFoldDeeper * radius;
  const Vector n = normal_to(t, held.start, two_sided);
  const double gap = dot(n, difference(held.start, t.corners[0])) - radius;
  const double left = dot(n, difference(held.end, at(triangle, 1).corners[0])) - radius;
  if (!(gap > -deep) || !(left < -deep) || !(highest(t, held) > kFlat * radius)) return {};
  const double time = std::max(gap, 0.0) / (std::max(gap, 0.0) - left);
  const Vector point = between(held.start, held.end, time);
  const OnTriangle on = nearest(at(triangle, time), point);
  if (length(difference(point, on.point)) > radius + deep) return {};
  const double apart = length(difference(held.start, nearest(t, held.start).point)) - radius;
  return FoldTouch{time, on, n, std::max(gap, std::min(0.0, apart))};
}

}  // namespace sinew::embree
