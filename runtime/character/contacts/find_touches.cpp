// find_touches.cpp  see find_touches.hpp.
#include "character/contacts/find_touches.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "character/contacts/own_body_touches.hpp"
#include "character/contacts/surface_point.hpp"
#include "character/transition/shares.hpp"
#include "core/check_hit.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
using MapVector = Eigen::Map<Vector3f>;
using ConstVector = Eigen::Map<const Vector3f>;

// Vertices are asked for where they are this near, of their patch's radius: displaced flesh is stretched.
constexpr float kStretched = 1.5f;
constexpr float kHardlyMoved = 1e-4f;

// From a tick's root, world axes: where something was a tick ago, and where it would be now.
struct Way {
  Vector3f start, end;
};

// A vertex of the character's patches, and whose it is.
struct Found {
  uint32_t region, node, vertex;
};

// Who is asked: the source, and capsules of its own body, a bit each.
struct Asked {
  bool source;
  uint64_t capsules;
  NormalsOf normals = NormalsOf::kFirstTouch;  // of the capsules
  bool nobody() const { return !source && capsules == 0; }
};

Asked asked_by(const Instance& instance, uint32_t region, NormalsOf normals = NormalsOf::kFirstTouch) {
  if (instance.level->leaves_out(region)) return {.source = false, .capsules = 0};
  return {instance.contacts.def.source && instance.contacts.def.tissue, touchable(instance, region), normals};
}

struct Question {
  Instance& instance;
  Asked asked;
  uint32_t count = 0;

  void add(const Way& way, float radius_m) {
    ContactProbe& probe = instance.contacts.probes[count++];
    const auto& root = instance.state->motion.tick_root_m;
    for (int k = 0; k < 3; ++k) {
      for (int e = 0; e < 2; ++e) {
        probe.start_m[e][k] = root[1][k] + static_cast<double>(way.start[k]);
        probe.end_m[e][k] = root[0][k] + static_cast<double>(way.end[k]);
      }
    }
    probe.radius_m = radius_m;
    probe.owner = instance.contacts.def.owner;
  }
  bool full() const { return count == kProbesAtOnce; }

  // The usable answers; `all` when there were more than fit.
  std::span<const ContactHit> ask(bool* all) {
    const std::span<const ContactProbe> probes = {instance.contacts.probes, count};
    const auto tick_s = static_cast<float>(instance.asset->tick_s);
    const std::span<ContactHit> room = {instance.contacts.hits, kHitsAtOnce};
    const uint32_t found = asked.source ? instance.contacts.def.source->find(probes, tick_s, room) : 0;
    const uint32_t of_source = std::min(found, kHitsAtOnce);
    const std::span<ContactHit> own_room = {instance.contacts.hits + of_source, kHitsAtOnce};
    const uint32_t own =
        asked.capsules ? find_own_body(instance, asked.capsules, asked.normals, probes, own_room) : 0;
    const uint32_t given = of_source + std::min(own, kHitsAtOnce);
    const auto end = std::remove_if(instance.contacts.hits, instance.contacts.hits + given,
                                    [&](const ContactHit& hit) { return !core::is_usable(hit, count); });
    const auto usable = static_cast<size_t>(end - instance.contacts.hits);
    instance.told.refused += given - static_cast<uint32_t>(usable);
    *all = found > kHitsAtOnce || own > kHitsAtOnce;
    return {instance.contacts.hits, usable};
  }
};

Vector3f node_place(const Instance& instance, uint32_t node, int age) {
  const tissue::NodePose& pose = instance.motion.poses[age][node];
  return ConstVector(pose.place_m) +
         Eigen::Map<const Rows33>(pose.rotation) * ConstVector(instance.tissue.u[age] + size_t{3} * node);
}

Way node_way(const Instance& instance, uint32_t node) {
  return {node_place(instance, node, 1), node_place(instance, node, 0)};
}

// The surface's displacement a tick ago, and now.
struct Displaced {
  const float *before, *now;
};

// From where it was shown.
Way vertex_way(const Instance& instance, const Found& found, const Displaced& displaced) {
  const SurfacePatches::Vertex& vertex = instance.level->patches.vertices[found.vertex];
  return {pushed_place(instance, found.region, vertex, displaced.before, 1),
          surface_point(instance, found.region, vertex, displaced.now, 0).place_m};
}

// To where it is pushed.
Way pushed_way(const Instance& instance, const Touch& touch) {
  const SurfacePatches::Vertex& vertex = instance.level->patches.vertices[touch.vertex];
  return {ConstVector(touch.start_m),
          pushed_place(instance, touch.region, vertex, instance.transition.shown[0], 0)};
}

float reach_m(const Instance& instance, uint32_t node) {
  return kStretched * instance.level->patches.radii_m[node];
}

struct Ball {
  Way middle;
  float radius_m;
};

Ball ball_around(const Instance& instance, const pack::RegionRecord& region) {
  Eigen::AlignedBox3f boxes[2];
  const uint32_t end = region.first_node + region.node_count;
  for (uint32_t n = region.first_node; n < end; ++n) {
    for (int age = 0; age < 2; ++age) boxes[age].extend(node_place(instance, n, age));
  }
  Ball ball{{boxes[1].center(), boxes[0].center()}, 0};
  for (uint32_t n = region.first_node; n < end; ++n) {
    const Way way = node_way(instance, n);
    const float far = std::max((way.start - ball.middle.start).norm(), (way.end - ball.middle.end).norm());
    ball.radius_m = std::max(ball.radius_m, far + reach_m(instance, n));
  }
  return ball;
}

// Those of them whom the region may touch.
Asked near_region(Instance& instance, const pack::RegionRecord& region, Asked asked) {
  const Ball ball = ball_around(instance, region);
  Question question{instance, {.source = asked.source, .capsules = 0}};
  question.add(ball.middle, ball.radius_m);
  asked.capsules = near_own_body(instance, asked.capsules, instance.contacts.probes[0]);
  bool all = false;
  asked.source = !question.ask(&all).empty();
  return asked;
}

// Both ends of a probe are the same point: what is answered twice is one.
bool is_known(const ContactState& contacts, uint32_t first, const Touch& touch) {
  constexpr float kSame = 0.999f;  // cosine
  for (uint32_t t = first; t < contacts.touch_count; ++t) {
    const Touch& known = contacts.touches[t];
    const bool alike = ConstVector(known.normal).dot(ConstVector(touch.normal)) > kSame;
    if (known.vertex == touch.vertex && alike && known.gap_m <= touch.gap_m) return true;
  }
  return false;
}

Touch touch_of(const Instance& instance, const Found& found, const ContactHit& hit) {
  Touch touch{.region = found.region, .node = found.node, .vertex = found.vertex};
  const ConstVector normal(hit.normal), velocity(hit.velocity_m_s);
  MapVector(touch.normal) = normal;
  const ContactProbe& probe = instance.contacts.probes[hit.probe];
  double way_m = -instance.asset->tick_s * static_cast<double>(normal.dot(velocity));
  for (int k = 0; k < 3; ++k) {
    way_m += static_cast<double>(hit.normal[k]) * (probe.end_m[0][k] - probe.start_m[0][k]);
    touch.place_m[k] = static_cast<float>(probe.end_m[0][k] - instance.state->motion.tick_root_m[0][k]);
    touch.start_m[k] = static_cast<float>(probe.start_m[0][k] - instance.state->motion.tick_root_m[1][k]);
  }
  touch.gap_m = static_cast<float>(hit.gap_m + way_m);
  return touch;
}

void keep(Instance& instance, uint32_t first, const Touch& touch) {
  if (is_known(instance.contacts, first, touch)) return;
  if (instance.contacts.touch_count == 2 * instance.level->patches.vertex_count)
    ++instance.told.dropped;
  else
    instance.contacts.touches[instance.contacts.touch_count++] = touch;
}

float moves_m(const Instance& instance, const ContactHit& hit) {
  return static_cast<float>(instance.asset->tick_s) * ConstVector(hit.velocity_m_s).norm();
}

// Vertices that are asked for together.
struct Vertices {
  Question question;
  float most_m;  // kept are touches that leave no larger gap
  Found found[kProbesAtOnce];

  void add(const Found& vertex, const Way& way) {
    found[question.count] = vertex;
    question.add(way, 0);
    if (question.full()) ask();
  }
  void ask() {
    if (question.count == 0) return;
    Instance& instance = question.instance;
    const uint32_t first = instance.contacts.touch_count;
    bool all = false;
    for (const ContactHit& hit : question.ask(&all)) {
      const Touch touch = touch_of(instance, found[hit.probe], hit);
      if (touch.gap_m < most_m) keep(instance, first, touch);
      instance.contacts.touched_moves_m = std::max(instance.contacts.touched_moves_m, moves_m(instance, hit));
    }
    instance.told.dropped += all;
    question.count = 0;
  }
};

// Nodes whose patch touches something are marked in `deepest`.
void find_patches(Instance& instance, const pack::RegionRecord& region, Asked asked) {
  constexpr uint32_t kTouched = 1;
  const uint32_t end = region.first_node + region.node_count;
  std::fill(instance.contacts.deepest + region.first_node, instance.contacts.deepest + end, 0u);
  Question question{instance, asked};
  for (uint32_t first = region.first_node, n = first; n < end; ++n) {
    question.add(node_way(instance, n), reach_m(instance, n));
    if (!question.full() && n + 1 < end) continue;
    bool all = false;
    for (const ContactHit& hit : question.ask(&all)) instance.contacts.deepest[first + hit.probe] = kTouched;
    if (all) std::fill(instance.contacts.deepest + first, instance.contacts.deepest + n + 1, kTouched);
    first = n + 1;
    question.count = 0;
  }
}

Asked asked_near(Instance& instance, uint32_t r) {
  const Asked asked = asked_by(instance, r);
  return asked.nobody() ? asked : near_region(instance, instance.level->pack.regions[r], asked);
}

// Vertices of patches that touch something, but for those of whom `leave` says so.
template <class Leave>
void find_vertices(Instance& instance, uint32_t r, const Displaced& displaced, float most_m, Leave leave) {
  const Asked asked = asked_near(instance, r);
  if (asked.nobody()) return;
  const pack::RegionRecord& region = instance.level->pack.regions[r];
  const SurfacePatches& patches = instance.level->patches;
  find_patches(instance, region, asked);
  Vertices vertices{{instance, asked}, most_m, {}};
  for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
    if (!instance.contacts.deepest[n]) continue;
    for (uint32_t v = patches.first[n]; v < patches.first[n + 1]; ++v) {
      const Found found{r, n, v};
      if (!leave(v)) vertices.add(found, vertex_way(instance, found, displaced));
    }
  }
  vertices.ask();
}

// What is there after the press is inside, or needs no more.
float inside_m(const pack::RegionRecord& region) {
  constexpr float kRounding = 1e-6f;  // of the region's radius
  return -kRounding * region.radius_m;
}

void mark_touched(Instance& instance) {
  std::fill_n(instance.contacts.touched, instance.level->patches.vertex_count, uint8_t{0});
  for (uint32_t t = 0; t < instance.contacts.touch_count; ++t)
    instance.contacts.touched[instance.contacts.touches[t].vertex] = 1;
}

bool nodes_stand_still(const Instance& instance, const pack::RegionRecord& region) {
  const auto& root = instance.state->motion.tick_root_m;
  const Vector3f on =
      (Eigen::Map<const Eigen::Vector3d>(root[0]) - Eigen::Map<const Eigen::Vector3d>(root[1])).cast<float>();
  for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
    const Way way = node_way(instance, n);
    if (!((way.end - way.start + on).norm() <= kHardlyMoved * region.radius_m)) return false;
  }
  return true;
}

}  // namespace

void find_touches(Instance& instance, uint32_t r) noexcept {
  find_vertices(instance, r, {instance.transition.shown[0], instance.contacts.flesh}, INFINITY,
                [](uint32_t) { return false; });
}

void find_late_touches(Instance& instance) noexcept {
  mark_touched(instance);
  for (uint32_t r = 0; r < instance.level->pack.regions.size(); ++r)
    find_vertices(instance, r, {instance.transition.shown[1], instance.transition.shown[0]},
                  inside_m(instance.level->pack.regions[r]),
                  [&](uint32_t v) { return instance.contacts.touched[v] != 0; });
}

void find_pushed_touches(Instance& instance) noexcept {
  mark_touched(instance);
  const uint32_t count = instance.contacts.touch_count;
  for (uint32_t first = 0, t = 0; t < count; first = t) {
    const uint32_t r = instance.contacts.touches[first].region;
    Vertices vertices{
        {instance, asked_by(instance, r, NormalsOf::kEnd)}, inside_m(instance.level->pack.regions[r]), {}};
    for (; t < count && instance.contacts.touches[t].region == r; ++t) {
      const Touch touch = instance.contacts.touches[t];
      if (std::exchange(instance.contacts.touched[touch.vertex], uint8_t{0}) == 0) continue;
      const Found found{r, touch.node, touch.vertex};
      vertices.add(found, pushed_way(instance, touch));
    }
    vertices.ask();
  }
}

bool touches_stand_still(const Instance& instance) noexcept {
  if (frame::is_simulated(instance.state->tier) && simulated_share(instance) < 1) return false;
  if (instance.contacts.touch_count == 0) return true;
  for (uint32_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    const bool still = instance.contacts.touched_moves_m <= kHardlyMoved * region.radius_m;
    if (!still || !nodes_stand_still(instance, region)) return false;
  }
  return true;
}

}  // namespace sinew::world
