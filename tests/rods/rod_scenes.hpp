// rod_scenes.hpp  Rods that the tests simulate, and what is measured on them.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "rods/rod_batch.hpp"
#include "rods/section.hpp"
#include "rods/solver/constraints.hpp"
#include "rods/turn.hpp"

namespace sinew::test {

using rods::RodBatch;
using rods::RodReport;
using rods::RodSettings;
using rods::SegmentDef;
using rods::StrandDef;
using Segments = std::vector<SegmentDef>;

// By default the rod of ROD_FACTS: 4 m, radius 0.02 m, 1000 kg/m^3, torsion modulus 1e6 Pa, along x, held at
// its root.
struct RodShape {
  uint32_t segments = 30;
  float young_pa = 1e6f;
  double length_m = 4;
  float radius_m = 0.02f;
  float torsion_pa = 1e6f;
  bool held = true;
};

inline constexpr float kHalfRoot = 0.70710678f;

// Own z along the world's x, own y along the world's y.
inline Segments straight_rod(const RodShape& shape) {
  Segments segments(shape.segments);
  const double length = shape.length_m / shape.segments;
  for (uint32_t i = 0; i < shape.segments; ++i) {
    SegmentDef& s = segments[i];
    s.position_m[0] = (i + 0.5) * length;
    s.orientation[1] = s.orientation[3] = kHalfRoot;
    s.length_m = static_cast<float>(length);
    s.radius_m = shape.radius_m;
    s.young_modulus_pa = shape.young_pa;
    s.torsion_modulus_pa = shape.torsion_pa;
    s.parent = i == 0 ? rods::kNoParent : i - 1;
  }
  segments[0].fixed = shape.held;
  return segments;
}

// A helix about y at rest: each segment turned against its parent by the same rotation.
inline Segments helix(uint32_t count, double segment_m = 0.02, float young_pa = 1e6f) {
  Segments segments(count);
  rods::Turn q = {0, 0, 0, 1};
  const rods::Turn by = rods::normalised({0.05, 0.15, 0.1, 1});
  rods::Vector end = {0, 0, 0};
  for (uint32_t i = 0; i < count; ++i) {
    SegmentDef& s = segments[i];
    if (i > 0) q = rods::product(q, by);
    const rods::Vector z = rods::turned(q, {0, 0, 1});
    for (size_t k = 0; k < 3; ++k) {
      s.position_m[k] = end[k] + 0.5 * segment_m * z[k];
      end[k] += segment_m * z[k];
    }
    for (size_t k = 0; k < 4; ++k) s.orientation[k] = static_cast<float>(q[k]);
    s.length_m = static_cast<float>(segment_m);
    s.radius_m = 0.002f;
    s.young_modulus_pa = s.torsion_modulus_pa = young_pa;
    s.parent = i == 0 ? rods::kNoParent : i - 1;
  }
  segments[0].fixed = true;
  return segments;
}

inline Status try_batch(const std::vector<Segments>& strands, const RodSettings& settings, RodBatch* out) {
  std::vector<StrandDef> defs;
  for (const Segments& s : strands) defs.push_back({s});
  return RodBatch::create(defs, settings, out);
}

// Of strands that are good; an empty batch otherwise.
inline RodBatch batch_of(const std::vector<Segments>& strands, const RodSettings& settings = {}) {
  RodBatch batch;
  return try_batch(strands, settings, &batch).ok() ? std::move(batch) : RodBatch();
}

inline RodReport step(RodBatch& batch, float dt_s) {
  RodReport report;
  return batch.step(dt_s, &report).ok() ? report : RodReport{.unconverged = ~0u};
}

inline rods::JointEnd joint_end(const rods::SegmentPose& pose, double length_m) {
  rods::JointEnd end{{}, {}, length_m};
  for (int k = 0; k < 3; ++k) end.position_m[k] = pose.position_m[k];
  for (int k = 0; k < 4; ++k) end.orientation[k] = static_cast<double>(pose.orientation[k]);
  return end;
}

inline rods::Vector axis_of(const rods::SegmentPose& pose) {
  return rods::turned(rods::turn_of(pose.orientation), {0, 0, 1});
}

// Where a segment ends.
inline rods::Vector end_of(const RodBatch& batch, const Segments& segments, uint32_t segment,
                           uint32_t strand = 0) {
  const rods::SegmentPose pose = batch.pose(strand, segment);
  const rods::Vector axis = axis_of(pose);
  rods::Vector out;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = pose.position_m[k] + 0.5 * static_cast<double>(segments[segment].length_m) * axis[k];
  }
  return out;
}

inline double distance(const rods::Vector& a, const rods::Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
inline double distance(const double (&a)[3], const double (&b)[3]) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Largest gap at a joint over its segment's length; infinity where a number is not finite.
inline double largest_stretch(const RodBatch& batch, const Segments& segments, uint32_t strand = 0) {
  double largest = 0;
  for (uint32_t i = 1; i < segments.size(); ++i) {
    const SegmentDef &a = segments[segments[i].parent], &b = segments[i];
    rods::Constraint c;
    if (!rods::stretch_shear(joint_end(batch.pose(strand, b.parent), static_cast<double>(a.length_m)),
                             joint_end(batch.pose(strand, i), static_cast<double>(b.length_m)), &c)) {
      return HUGE_VAL;
    }
    largest =
        std::max(largest, std::hypot(c.value[0], c.value[1], c.value[2]) / static_cast<double>(b.length_m));
  }
  return largest;
}

// Length of a chain or tree from joint to joint over its length at rest.
inline double length_ratio(const RodBatch& batch, const Segments& segments, uint32_t strand = 0) {
  double length = 0, at_rest = 0;
  for (uint32_t i = 1; i < segments.size(); ++i) {
    length +=
        distance(end_of(batch, segments, i, strand), end_of(batch, segments, segments[i].parent, strand));
    at_rest += static_cast<double>(segments[i].length_m);
  }
  return length / at_rest;
}

// A trunk of `trunk` segments along y with a branch of `branch` from each of its segments.
inline Segments branched_rod(uint32_t trunk, uint32_t branch, float young_pa) {
  Segments segments;
  const auto add = [&](uint32_t parent, const rods::Turn& turn) {
    rods::Vector begin = {0, 0, 0};
    const rods::Vector z = rods::turned(turn, {0, 0, 1});
    if (parent != rods::kNoParent) {
      rods::SegmentPose pose;
      std::copy_n(segments[parent].position_m, 3, pose.position_m);
      std::copy_n(segments[parent].orientation, 4, pose.orientation);
      const rods::Vector axis = axis_of(pose);
      for (size_t k = 0; k < 3; ++k) begin[k] = pose.position_m[k] + 0.05 * axis[k];
    }
    SegmentDef s;
    for (size_t k = 0; k < 3; ++k) s.position_m[k] = begin[k] + 0.05 * z[k];
    for (size_t k = 0; k < 4; ++k) s.orientation[k] = static_cast<float>(turn[k]);
    s.length_m = 0.1f;
    s.radius_m = 0.01f;
    s.young_modulus_pa = s.torsion_modulus_pa = young_pa;
    s.parent = parent;
    segments.push_back(s);
    return static_cast<uint32_t>(segments.size() - 1);
  };
  const rods::Turn up = rods::normalised({-1, 0, 0, 1}), aside = rods::normalised({-0.6, 0.3, 0, 1});
  uint32_t below = add(rods::kNoParent, up);
  segments[0].fixed = true;
  for (uint32_t i = 1; i < trunk; ++i) {
    uint32_t twig = below;
    for (uint32_t k = 0; k < branch; ++k) twig = add(twig, aside);
    below = add(below, up);
  }
  return segments;
}

struct Energy {
  double kinetic_j = 0, bending_j = 0, height_j = 0;
  double sum_j() const { return kinetic_j + bending_j + height_j; }
};

// Kinetic, elastic and against gravity along -y; stretch has none in rods that do not stretch.
inline Energy energy(const RodBatch& batch, const Segments& segments, double gravity_m_s2,
                     uint32_t strand = 0) {
  Energy out;
  for (uint32_t i = 0; i < segments.size(); ++i) {
    const SegmentDef& s = segments[i];
    const rods::SegmentPose pose = batch.pose(strand, i);
    const rods::SegmentVelocity v = batch.velocity(strand, i);
    const rods::SegmentInertia inertia = rods::segment_inertia(s);
    if (!s.fixed) {
      const rods::Vector w =
          rods::turned_back(rods::turn_of(pose.orientation), rods::vector_of(v.angular_rad_s));
      for (const float x : v.linear_m_s) out.kinetic_j += 0.5 * inertia.mass_kg * static_cast<double>(x * x);
      out.kinetic_j += 0.5 * inertia.inertia_kg_m2 * (w[0] * w[0] + w[1] * w[1]);
      out.kinetic_j += 0.5 * inertia.axial_inertia_kg_m2 * w[2] * w[2];
      out.height_j += inertia.mass_kg * gravity_m_s2 * pose.position_m[1];
    }
    if (i == 0) continue;
    const SegmentDef& parent = segments[s.parent];
    const auto rest_end = [](const SegmentDef& d) {
      rods::SegmentPose rest{};
      std::copy_n(d.orientation, 4, rest.orientation);
      return joint_end(rest, static_cast<double>(d.length_m));
    };
    double rest[3] = {};
    rods::darboux(rest_end(parent), rest_end(s), rest);
    rods::Constraint c{};
    rods::bend_twist(joint_end(batch.pose(strand, s.parent), 1), joint_end(pose, 1), rest, &c);
    const rods::JointCompliance soft = rods::joint_compliance(parent, s);
    out.bending_j += 0.5 * (c.value[0] * c.value[0] + c.value[1] * c.value[1]) / soft.bend_rad_nm;
    out.bending_j += 0.5 * c.value[2] * c.value[2] / soft.twist_rad_nm;
  }
  return out;
}

}  // namespace sinew::test
