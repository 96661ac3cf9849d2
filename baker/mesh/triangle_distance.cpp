// triangle_distance.cpp  The foot on the plane where it lies inside, else the nearest edge.
#include "baker/mesh/triangle_distance.hpp"

#include <algorithm>

namespace sinew::baker {
namespace {

double distance_to_edge(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0;
  return (p - a - share * along).norm();
}

}  // namespace

double distance_to_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Vector3& from, const Vector3& to) {
    return (to - from).cross(p - from).dot(normal) >= 0;
  };
  if (normal.squaredNorm() > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return std::abs((p - a).dot(normal)) / normal.norm();
  return std::min({distance_to_edge(p, a, b), distance_to_edge(p, b, c), distance_to_edge(p, c, a)});
}

}  // namespace sinew::baker
