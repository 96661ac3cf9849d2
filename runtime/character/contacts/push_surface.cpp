// push_surface.cpp  see push_surface.hpp.
#include "character/contacts/push_surface.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "character/contacts/find_touches.hpp"
#include "character/contacts/surface_point.hpp"
#include "character/output/displacement_bound.hpp"
#include "character/parameters/tuned_parts.hpp"

namespace sinew::world {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using ConstVector = Eigen::Map<const Vector3f>;

Vector3f in_bind(const Matrix3f& world_from_bind, const Vector3f& v) {
  constexpr float kCollapsed = 1e-6f;  // of a skin matrix that has no inverse
  if (!(std::fabs(world_from_bind.determinant()) > kCollapsed)) return world_from_bind.transpose() * v;
  return world_from_bind.inverse() * v;
}

// No further than the limit, all pushes of a vertex together, in the bind pose too: where skinning flattens
// the flesh, a short way out is a long one there.
Vector3f held(const SurfacePoint& at, const Vector3f& push, float limit_m) {
  const Vector3f moved = at.world_from_bind * push;
  const float length_m =
      std::max(std::hypot(moved.x(), moved.y(), moved.z()), std::hypot(push.x(), push.y(), push.z()));
  if (length_m <= limit_m) return push;
  return length_m < HUGE_VALF ? Vector3f(limit_m / length_m * push) : Vector3f(Vector3f::Zero());
}

// Of the first so many touches: by what presses from the same side.
bool is_told(const ContactState& contacts, uint32_t first, const Touch& touch) {
  constexpr float kSameSide = 0.9f;  // cosine
  return std::any_of(contacts.touches, contacts.touches + first, [&](const Touch& known) {
    return known.vertex == touch.vertex && known.gap_m < 0 &&
           ConstVector(known.normal).dot(ConstVector(touch.normal)) > kSameSide;
  });
}

// told: how many touches are in the report.
void push_vertex(Instance& instance, const Touch& touch, uint32_t told) {
  const GraphLevel& level = *instance.level;
  const pack::RegionRecord& region = level.pack.regions[touch.region];
  const SurfacePatches::Vertex& vertex = level.patches.vertices[touch.vertex];
  const SurfacePoint now = surface_point(instance, touch.region, vertex, instance.transition.shown[0], 0);
  size_t pitch = 0;
  float* push = push_of(instance, touch.region, vertex, &pitch);
  const Vector3f before(push[0], push[pitch], push[2 * pitch]);
  const ConstVector normal(touch.normal);
  const float carried = normal.dot(now.place_m - ConstVector(touch.place_m));
  const float pushed = normal.dot(now.world_from_bind * before);
  const float out = std::max(0.0f, -touch.gap_m - carried - pushed);
  const float most_m =
      std::min(region.displacement_limit_m, displacement_bound_m(*instance.asset, touch.region));
  const Vector3f after = held(now, before + in_bind(now.world_from_bind, out * normal), most_m);
  for (size_t k = 0; k < 3; ++k) push[k * pitch] = after[static_cast<Eigen::Index>(k)];
  instance.contacts.pushed[touch.region] |= out > 0;
  if (!(touch.gap_m < 0) || is_told(instance.contacts, told, touch)) return;
  ++instance.told.vertices;
  instance.told.volume_m3 +=
      vertex.area_m2 * std::max(0.0f, carried + normal.dot(now.world_from_bind * after));
}

// Where it is shown in the end.
void look_at_vertex(Instance& instance, const Touch& touch) {
  const SurfacePatches::Vertex& vertex = instance.level->patches.vertices[touch.vertex];
  const Vector3f place = pushed_place(instance, touch.region, vertex, instance.transition.shown[0], 0);
  const float moved = ConstVector(touch.normal).dot(place - ConstVector(touch.place_m));
  instance.told.deepest_m = std::max(instance.told.deepest_m, -touch.gap_m - moved);
}

void push_vertices(Instance& instance, uint32_t first) {
  for (uint32_t t = first; t < instance.contacts.touch_count; ++t)
    push_vertex(instance, instance.contacts.touches[t], first);
}

}  // namespace

void forget_pushes(Instance& instance) noexcept {
  if (!instance.contacts.pushes) return;
  float* pushes = instance.contacts.pushes;
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const size_t floats = size_t{3} * instance.level->pack.regions[r].padded_vertices;
    if (instance.contacts.pushed[r]) std::fill_n(pushes, floats, 0.0f);
    instance.contacts.pushed[r] = 0;
    pushes += floats;
  }
}

void push_surface(Instance& instance) noexcept {
  if (!instance.contacts.pushes) return;
  const bool more = !touches_stand_still(instance);
  if (more) find_late_touches(instance);
  forget_pushes(instance);
  push_vertices(instance, 0);
  const uint32_t first = instance.contacts.touch_count;
  if (more) find_pushed_touches(instance);
  push_vertices(instance, first);
  for (uint32_t t = 0; t < instance.contacts.touch_count; ++t)
    look_at_vertex(instance, instance.contacts.touches[t]);
  instance.told.touches = std::exchange(instance.contacts.touch_count, 0u);
}

}  // namespace sinew::world
