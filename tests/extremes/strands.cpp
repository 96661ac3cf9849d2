// strands.cpp  see strands.hpp.
#include "tests/extremes/strands.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "rods/contacts/collider.hpp"
#include "tests/extremes/act.hpp"
#include "tests/rods/rod_scenes.hpp"

namespace sinew::extremes {
namespace {

constexpr const char* kNames[kStrandScenes] = {"held end flies", "thrown",          "pushed", "hit",
                                               "held at both",   "several of these"};
enum : uint32_t { kFlies = 1, kThrown = 2, kPushed = 4, kHit = 8, kBoth = 16 };

struct Strand {
  test::Segments segments;
  rods::RodBatch batch;
  double length_m = 0;
};

// Each segment as long as it comes, up to thirty times its neighbour; the whole as long as before.
void make_uneven(Draws& draws, double length_m, test::Segments& segments) {
  std::vector<double> lengths(segments.size());
  for (double& length : lengths) length = draws.of_any_size(1, 30);
  const double all = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  double begin_m = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    const double own_m = lengths[i] * length_m / all;
    segments[i].position_m[0] = begin_m + own_m / 2;
    segments[i].length_m = static_cast<float>(own_m);
    begin_m += own_m;
  }
}

Strand make(Draws& draws, uint32_t does) {
  Strand out;
  const uint32_t count = 2 + draws.below(30);
  out.length_m = draws.of_any_size(0.02, 5);
  const auto young_pa = static_cast<float>(draws.of_any_size(1e3, 1e10));
  if (draws.chance(0.2) && count >= 6) {
    out.segments = test::branched_rod(count / 3, 2, young_pa);
  } else {
    out.segments = test::straight_rod({.segments = count,
                                       .young_pa = young_pa,
                                       .length_m = out.length_m,
                                       .radius_m = static_cast<float>(out.length_m / count / 6),
                                       .torsion_pa = young_pa / 3});
    if (draws.chance(0.3)) make_uneven(draws, out.length_m, out.segments);
  }
  if (does & kBoth) out.segments.back().fixed = true;
  const float teleport = draws.chance(0.5) ? 2.0f : 1e6f;
  out.batch = test::batch_of({out.segments}, {.max_iterations = draws.chance(0.5) ? 12 : 1 + draws.below(12),
                                              .teleport_lengths = teleport});
  if (out.batch.segment_count() == 0) throw std::runtime_error("no batch");
  return out;
}

struct Ends {
  rods::Vector of[2];
};
Ends ends_of(const Strand& strand, uint32_t segment) {
  const rods::SegmentPose pose = strand.batch.pose(0, segment);
  const rods::Vector axis = test::axis_of(pose);
  Ends out;
  for (size_t k = 0; k < 3; ++k) {
    const double half = 0.5 * static_cast<double>(strand.segments[segment].length_m) * axis[k];
    out.of[0][k] = pose.position_m[k] - half, out.of[1][k] = pose.position_m[k] + half;
  }
  return out;
}

// From the middle of a segment along the strand to those of all others.
std::vector<double> ways_from(const Strand& strand, uint32_t segment) {
  std::vector<double> way(strand.segments.size(), HUGE_VAL);
  way[segment] = 0;
  const auto step = [&](size_t from, size_t to) {
    way[to] = std::min(way[to], way[from] + (static_cast<double>(strand.segments[from].length_m) +
                                             static_cast<double>(strand.segments[to].length_m)) /
                                                2);
  };
  for (size_t i = way.size(); i-- > 1;) step(i, strand.segments[i].parent);
  for (size_t i = 1; i < way.size(); ++i) step(strand.segments[i].parent, i);
  return way;
}

double reach_of(const Strand& strand, bool* finite) {
  std::vector<double> reach(strand.segments.size(), HUGE_VAL);  // of the nearest that is held
  for (uint32_t h = 0; h < reach.size(); ++h) {
    if (!strand.segments[h].fixed) continue;
    const std::vector<double> way = ways_from(strand, h);
    const double length_m = *std::ranges::max_element(way);
    const rods::SegmentPose held = strand.batch.pose(0, h);
    for (uint32_t i = 0; i < reach.size(); ++i) {
      double far_m = 0;
      for (const rods::Vector& end : ends_of(strand, i).of)
        far_m = std::max(far_m, std::hypot(end[0] - held.position_m[0], end[1] - held.position_m[1],
                                           end[2] - held.position_m[2]));
      *finite = *finite && std::isfinite(far_m);
      const double way_m = way[i] + static_cast<double>(strand.segments[i].length_m) / 2;
      reach[i] = std::min(reach[i], 1 + (far_m - way_m) / length_m);
    }
  }
  return *std::ranges::max_element(reach);
}

}  // namespace

const char* strand_scene_name(uint32_t scene) { return kNames[scene]; }

StrandOutcome play_strand(uint32_t scene, uint64_t seed, uint32_t steps) {
  Draws draws(seed);
  const uint32_t does = scene + 1 < kStrandScenes ? 1u << scene : 1 + draws.below(31);
  Strand strand = make(draws, does);
  rods::RodBatch& batch = strand.batch;
  AnyHits hits;
  hits.seed = seed;
  hits.depth_m = strand.length_m * draws.of_any_size(1e-3, 10);
  hits.speed_m_s = draws.of_any_size(0.1, 1e5);
  hits.share = draws.of_any_size(0.02, 1);
  rods::RodCollider collider;
  if ((does & kHit) && (!rods::RodCollider::create(batch, {.source_capacity = 256}, &collider).ok() ||
                        !collider.set_source(&hits).ok()))
    throw std::runtime_error("no collider");
  const double jump_m = strand.length_m * draws.of_any_size(0.05, 1e5), share = draws.between(0.02, 1);
  const float speed_m_s = static_cast<float>(draws.of_any_size(1, 1e6)),
              force_n = static_cast<float>(draws.of_any_size(1e-3, 1e6)),
              dt_s = draws.chance(0.5) ? 1.0f / 60 : static_cast<float>(draws.of_any_size(1e-4, 0.1));
  StrandOutcome out;
  for (uint32_t t = 0; t < steps; ++t) {
    double way[3];
    for (uint32_t i = 0; i < batch.segment_count(); ++i) {
      draws.direction(way);
      const bool fixed = strand.segments[i].fixed;
      if (fixed && (does & (kFlies | kBoth)) && draws.chance(share)) {
        rods::SegmentPose target = batch.pose(0, i);
        for (int k = 0; k < 3; ++k)
          target.position_m[k] += way[k] * (does & kFlies ? jump_m : 0.1 * strand.length_m);
        (void)batch.set_target(0, i, target);
      }
      if (!fixed && (does & kThrown) && draws.chance(0.1 * share)) {
        rods::SegmentVelocity velocity;
        for (int k = 0; k < 3; ++k)
          velocity.linear_m_s[k] = velocity.angular_rad_s[k] = speed_m_s * static_cast<float>(way[k]);
        (void)batch.set_velocity(0, i, velocity);
      }
      if (!fixed && (does & kPushed) && draws.chance(0.1 * share)) {
        const float push_n[3] = {force_n * static_cast<float>(way[0]), force_n * static_cast<float>(way[1]),
                                 force_n * static_cast<float>(way[2])};
        (void)batch.set_force(0, i, push_n);
      }
    }
    (void)(does & kHit ? batch.step(dt_s, &collider, nullptr) : batch.step(dt_s, nullptr));
    out.reach = std::max(out.reach, reach_of(strand, &out.finite));
  }
  return out;
}

}  // namespace sinew::extremes
