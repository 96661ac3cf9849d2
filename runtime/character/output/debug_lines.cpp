// debug_lines.cpp  see debug_lines.hpp.
#include "character/output/debug_lines.hpp"

#include <cmath>
#include <numbers>

#include "character/motion/placement.hpp"
#include "character/output/displacement_bound.hpp"
#include "character/output/shown_skin.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr uint32_t kOrange = 0xff8c00ff, kCyan = 0x00c8ffff, kGrey = 0xa0a0a0ff, kRed = 0xff2020ff,
                   kYellow = 0xffe600ff;
constexpr int kCircleEdges = 16;

// Counts all, keeps what there is room for.
class Pen {
 public:
  explicit Pen(std::span<DebugLine> out) noexcept : out_(out) {}
  size_t count() const noexcept { return count_; }

  void line(const Vector3f& from, const Vector3f& to, uint32_t rgba) noexcept {
    if (count_ < out_.size()) out_[count_] = {{from.x(), from.y(), from.z()}, {to.x(), to.y(), to.z()}, rgba};
    ++count_;
  }
  // a and b: radii at right angles.
  void circle(const Vector3f& centre, const Vector3f& a, const Vector3f& b, uint32_t rgba) noexcept {
    Vector3f last = centre + a;
    for (int i = 1; i <= kCircleEdges; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kCircleEdges;
      const Vector3f next = centre + std::cos(angle) * a + std::sin(angle) * b;
      line(last, next, rgba);
      last = next;
    }
  }

 private:
  std::span<DebugLine> out_;
  size_t count_ = 0;
};

void draw_nodes(const Instance& instance, const ShownSkin& skin, const Placement& to, Pen& pen) noexcept {
  if (!instance.marks.displaced) return;
  const std::span<const pack::NodeRecord> nodes = instance.level->pack.nodes;
  for (size_t n = 0; n < nodes.size(); ++n) {
    const SkinMatrix m = blended(nodes[n].skin, skin.matrices());
    const float bound_m = displacement_bound_m(*instance.asset, nodes[n].region);
    const Vector3f bind(nodes[n].position_m),
        delta = within_bound(Vector3f(instance.published.delta + 3 * n), bound_m);
    const auto moved = [&](const Vector3f& p) { return to.place(m.leftCols<3>() * p + m.col(3)); };
    pen.line(moved(bind), moved(bind + instance.published.carried_share * delta), kOrange);
  }
}

void draw_rods(const Instance& instance, const Placement& to, Pen& pen) noexcept {
  for (const pack::RodSegmentRecord& segment : instance.level->pack.rod_segments) {
    if (segment.joint == pack::kNoIndex) continue;
    const SkinMatrix m = shown_skin(instance, segment.joint);
    const auto moved = [&](const float* p) { return to.place(m.leftCols<3>() * Vector3f(p) + m.col(3)); };
    pen.line(moved(segment.begin_m), moved(segment.end_m), kCyan);
  }
}

void draw_capsule(const Vector3f& from, const Vector3f& end, float radius_m, Pen& pen) noexcept {
  const Vector3f axis = end - from;
  const float length = axis.norm();
  const Vector3f along = length > 0 ? Vector3f(axis / length) : Vector3f::UnitY();
  const Vector3f a = radius_m * along.unitOrthogonal(), b = along.cross(a), up = radius_m * along;
  for (const Vector3f& centre : {from, end}) {
    pen.circle(centre, a, b, kGrey);
    pen.circle(centre, a, up, kGrey);
    pen.circle(centre, b, up, kGrey);
  }
  for (const Vector3f& side : {a, b, Vector3f(-a), Vector3f(-b)}) pen.line(from + side, end + side, kGrey);
}

void draw_proxies(const Instance& instance, const Placement& to, Pen& pen) noexcept {
  for (const pack::ProxyRecord& proxy : instance.level->pack.proxies) {
    const SkinMatrix m = shown_skin(instance, proxy.joint);
    const auto moved = [&](const float* p) { return to.place(m.leftCols<3>() * Vector3f(p) + m.col(3)); };
    draw_capsule(moved(proxy.from_m), moved(proxy.to_m), to.scale * proxy.radius_m, pen);
  }
}

// Kept from the tick's root, in world axes and the character's own metres.
void draw_touches(const Instance& instance, const double (&origin_m)[3], Pen& pen) noexcept {
  constexpr float kShare = 0.05f;
  const InstanceState& state = *instance.state;
  const auto scale = static_cast<float>(state.motion.root.scale);
  Vector3f root;
  for (int k = 0; k < 3; ++k)
    root[k] = static_cast<float>(state.motion.root.scale * state.motion.tick_root_m[0][k] - origin_m[k]);
  for (uint32_t t = 0; t < instance.told.touches; ++t) {
    const Vector3f place = root + scale * Vector3f(instance.contacts.touches[t].place_m);
    const float length = kShare * scale * instance.level->pack.character->height_m;
    pen.line(place, place + length * Vector3f(instance.contacts.touches[t].normal), kRed);
  }
}

void draw_bounds(const Instance& instance, const double (&origin_m)[3], Pen& pen) noexcept {
  const Vector3f centre =
      (Vector3d(instance.bound.middle_m) - Eigen::Map<const Vector3d>(origin_m)).cast<float>();
  const Vector3f x = instance.bound.radius_m * Vector3f::UnitX(),
                 y = instance.bound.radius_m * Vector3f::UnitY(),
                 z = instance.bound.radius_m * Vector3f::UnitZ();
  pen.circle(centre, x, y, kYellow);
  pen.circle(centre, y, z, kYellow);
  pen.circle(centre, z, x, kYellow);
}

}  // namespace

size_t draw_lines(const Instance& instance, uint32_t parts, const double (&origin_m)[3],
                  std::span<DebugLine> out) noexcept {
  Pen pen(out);
  const Placement to = placement_of(instance, Space::kWorld, origin_m);
  if (parts & kDebugNodes) draw_nodes(instance, ShownSkin(instance), to, pen);
  if (parts & kDebugRods) draw_rods(instance, to, pen);
  if (parts & kDebugProxies) draw_proxies(instance, to, pen);
  if (parts & kDebugTouches) draw_touches(instance, origin_m, pen);
  if (parts & kDebugBounds) draw_bounds(instance, origin_m, pen);
  return pen.count();
}

}  // namespace sinew::world
