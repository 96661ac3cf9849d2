// side.cpp  Pseudonormals, where they are asked for.
#include "adapters/embree/side.hpp"

#include <algorithm>

#include "rods/vector.hpp"

namespace sinew::embree {
namespace {

using namespace rods;

Vector unit(const Vector& v) {
  const double size = length(v);
  return size > 0 ? scaled(1 / size, v) : Vector{};
}

Vector face_normal(const Triangle& t) {
  return unit(cross(difference(t.corners[1], t.corners[0]), difference(t.corners[2], t.corners[0])));
}

double angle_at(const Triangle& t, size_t k) {
  const Vector a = difference(t.corners[(k + 1) % 3], t.corners[k]);
  const Vector b = difference(t.corners[(k + 2) % 3], t.corners[k]);
  return std::atan2(length(cross(a, b)), dot(a, b));
}

Vector edge_normal(const Surface& surface, uint32_t groups, uint32_t triangle, uint32_t k) {
  const uint32_t other = surface.topology().across[triangle][k];
  if (other == kBorder || !(surface.groups(other) & groups)) return {};
  return sum(face_normal(surface.start_triangle(triangle)), face_normal(surface.start_triangle(other)));
}

Vector corner_normal(const Surface& surface, uint32_t groups, uint32_t vertex) {
  const Topology& topology = surface.topology();
  if (topology.border[vertex]) return {};
  Vector out = {};
  for (uint32_t i = topology.fan_begin[vertex]; i < topology.fan_begin[vertex + 1]; ++i) {
    const uint32_t triangle = topology.fan[i];
    if (!(surface.groups(triangle) & groups)) return {};
    const Triangle t = surface.start_triangle(triangle);
    const Corners& corners = topology.triangles[triangle];
    const size_t k = static_cast<size_t>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
    out = scaled_sum(angle_at(t, k), face_normal(t), out);
  }
  return out;
}

}  // namespace

Vector pseudonormal(const Surface& surface, uint32_t groups, uint32_t triangle, uint32_t feature) noexcept {
  if (feature >= kFace) return face_normal(surface.start_triangle(triangle));
  if (feature >= kEdge) return edge_normal(surface, groups, triangle, feature - kEdge);
  return corner_normal(surface, groups, surface.topology().triangles[triangle][feature]);
}

Side side_of(const Surface& surface, uint32_t groups, uint32_t triangle, const OnTriangle& on,
             const Vector& point) noexcept {
  const Vector n = pseudonormal(surface, groups, triangle, on.feature);
  return dot(difference(point, on.point), n) < 0 ? Side::kInside : Side::kOutside;
}

}  // namespace sinew::embree
