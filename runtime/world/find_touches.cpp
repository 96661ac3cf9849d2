// find_touches.cpp  see find_touches.hpp.
#include "world/find_touches.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <span>

#include "core/check_hit.hpp"
#include "world/own_body_touches.hpp"
#include "world/surface_point.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
using MapVector = Eigen::Map<Vector3f>;
using ConstVector = Eigen::Map<const Vector3f>;

// Vertices are asked for where they are this near, of their patch's radius: displaced flesh is stretched.
constexpr float kStretched = 1.5f;

// From a tick's root, world axes: where something was a tick ago, and where it would be now.
struct Way {
  Vector3f start, end;
};

// Who is asked: the source, and capsules of its own body, a bit each.
struct Asked {
  bool source;
  uint64_t capsules;
  bool nobody() const { return !source && capsules == 0; }
};

Asked asked_by(const Instance& instance, uint32_t region) {
  return {instance.contacts.source && instance.contacts.tissue, touchable(instance, region)};
}

struct Question {
  Instance& instance;
  Asked asked;
  uint32_t count = 0;

  void add(const Way& way, float radius_m) {
    ContactProbe& probe = instance.probes[count++];
    const auto& root = instance.state->tick_root_m;
    for (int k = 0; k < 3; ++k) {
      for (int e = 0; e < 2; ++e) {
        probe.start_m[e][k] = root[1][k] + static_cast<double>(way.start[k]);
        probe.end_m[e][k] = root[0][k] + static_cast<double>(way.end[k]);
      }
    }
    probe.radius_m = radius_m;
    probe.owner = instance.contacts.owner;
  }
  bool full() const { return count == kProbesAtOnce; }

  // The usable answers; `all` when there were more than fit.
  std::span<const ContactHit> ask(bool* all) {
    const std::span<const ContactProbe> probes = {instance.probes, count};
    const auto tick_s = static_cast<float>(instance.asset->tick_s);
    const std::span<ContactHit> room = {instance.hits, kHitsAtOnce};
    const uint32_t found = asked.source ? instance.contacts.source->find(probes, tick_s, room) : 0;
    const uint32_t of_source = std::min(found, kHitsAtOnce);
    const uint32_t own = find_own_body(instance, asked.capsules, probes, room.subspan(of_source));
    const uint32_t given = std::min(of_source + own, kHitsAtOnce);
    const auto end = std::remove_if(instance.hits, instance.hits + given,
                                    [&](const ContactHit& hit) { return !core::is_usable(hit, count); });
    const auto usable = static_cast<size_t>(end - instance.hits);
    instance.told.refused += given - static_cast<uint32_t>(usable);
    *all = found > kHitsAtOnce || of_source + own > kHitsAtOnce;
    return {instance.hits, usable};
  }
};

Vector3f node_place(const Instance& instance, uint32_t node, int age) {
  const tissue::NodePose& pose = instance.poses[age][node];
  return ConstVector(pose.place_m) +
         Eigen::Map<const Rows33>(pose.rotation) * ConstVector(instance.u[age] + size_t{3} * node);
}

Way node_way(const Instance& instance, uint32_t node) {
  return {node_place(instance, node, 1), node_place(instance, node, 0)};
}

// From where it was shown.
Way vertex_way(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex) {
  const SurfacePoint before = surface_point(instance, region, vertex, instance.shown[0], 1);
  size_t pitch = 0;
  const float* push = push_of(instance, region, vertex, &pitch);
  return {before.place_m + before.world_from_bind * Vector3f(push[0], push[pitch], push[2 * pitch]),
          surface_point(instance, region, vertex, instance.flesh, 0).place_m};
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
  Question question{instance, {asked.source, 0}};
  question.add(ball.middle, ball.radius_m);
  asked.capsules = near_own_body(instance, asked.capsules, instance.probes[0]);
  bool all = false;
  asked.source = !question.ask(&all).empty();
  return asked;
}

struct Found {
  uint32_t region, node, vertex;
  Vector3f place;
};

// Both ends of a probe are the same point: what is answered twice is one.
bool is_known(const Instance& instance, uint32_t first, const Touch& touch) {
  constexpr float kSame = 0.999f;  // cosine
  for (uint32_t t = first; t < instance.touch_count; ++t) {
    const Touch& known = instance.touches[t];
    const bool alike = ConstVector(known.normal).dot(ConstVector(touch.normal)) > kSame;
    if (known.vertex == touch.vertex && alike && known.gap_m <= touch.gap_m) return true;
  }
  return false;
}

void keep(Instance& instance, uint32_t first, const Found& found, const ContactHit& hit) {
  Touch touch{.region = found.region, .node = found.node, .vertex = found.vertex};
  const ConstVector normal(hit.normal), velocity(hit.velocity_m_s);
  MapVector(touch.normal) = normal;
  MapVector(touch.place_m) = found.place;
  const ContactProbe& probe = instance.probes[hit.probe];
  double way_m = -instance.asset->tick_s * static_cast<double>(normal.dot(velocity));
  for (int k = 0; k < 3; ++k)
    way_m += static_cast<double>(hit.normal[k]) * (probe.end_m[0][k] - probe.start_m[0][k]);
  touch.gap_m = static_cast<float>(hit.gap_m + way_m);
  if (is_known(instance, first, touch)) return;
  if (instance.touch_count == 2 * instance.level->patches.vertex_count)
    ++instance.told.dropped;
  else
    instance.touches[instance.touch_count++] = touch;
}

void ask_vertices(Instance& instance, Question& question, const Found* found) {
  bool all = false;
  const uint32_t first = instance.touch_count;
  for (const ContactHit& hit : question.ask(&all)) keep(instance, first, found[hit.probe], hit);
  instance.told.dropped += all;
  question.count = 0;
}

// Nodes whose patch touches something are marked in `deepest`.
void find_patches(Instance& instance, const pack::RegionRecord& region, Asked asked) {
  constexpr uint32_t kTouched = 1;
  const uint32_t end = region.first_node + region.node_count;
  std::fill(instance.deepest + region.first_node, instance.deepest + end, 0u);
  Question question{instance, asked};
  for (uint32_t first = region.first_node, n = first; n < end; ++n) {
    question.add(node_way(instance, n), reach_m(instance, n));
    if (!question.full() && n + 1 < end) continue;
    bool all = false;
    for (const ContactHit& hit : question.ask(&all)) instance.deepest[first + hit.probe] = kTouched;
    if (all) std::fill(instance.deepest + first, instance.deepest + n + 1, kTouched);
    first = n + 1;
    question.count = 0;
  }
}

}  // namespace

void find_touches(Instance& instance, uint32_t r) noexcept {
  const pack::RegionRecord& region = instance.level->pack.regions[r];
  const SurfacePatches& patches = instance.level->patches;
  Asked asked = asked_by(instance, r);
  if (asked.nobody()) return;
  asked = near_region(instance, region, asked);
  if (asked.nobody()) return;
  find_patches(instance, region, asked);
  Found found[kProbesAtOnce];
  Question question{instance, asked};
  for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
    if (!instance.deepest[n]) continue;
    for (uint32_t v = patches.first[n]; v < patches.first[n + 1]; ++v) {
      const Way way = vertex_way(instance, r, patches.vertices[v]);
      found[question.count] = {r, n, v, way.end};
      question.add(way, 0);
      if (question.full()) ask_vertices(instance, question, found);
    }
  }
  if (question.count > 0) ask_vertices(instance, question, found);
}

}  // namespace sinew::world
