// fill_batch.cpp  Strands' numbers in their own units, put where the kernels read them.
#include <algorithm>
#include <cmath>

#include "rods/create/batch_builder.hpp"
#include "rods/section.hpp"
#include "rods/solver/constraints.hpp"
#include "rods/state/joint_fields.hpp"

namespace sinew::rods {
namespace {

JointEnd joint_end(const SegmentDef& s) {
  JointEnd end = {{s.position_m[0], s.position_m[1], s.position_m[2]}, {}, s.length_m};
  double square = 0;
  for (const float q : s.orientation) square += static_cast<double>(q) * q;
  for (int k = 0; k < 4; ++k) end.orientation[k] = s.orientation[k] / std::sqrt(square);
  return end;
}

}  // namespace

void RodBatchBuilder::set_units(const StrandDef& strand, uint32_t index) {
  double length = 0, mass = 0;
  for (const SegmentDef& s : strand.segments) {
    length += s.length_m;
    mass += segment_inertia(s).mass_kg;
  }
  RodBatch::Units& units = batch.units_[index];
  std::copy_n(strand.segments[0].position_m, 3, units.origin_m);
  units.length_m = static_cast<float>(length / batch.segment_count_);
  units.mass_kg = static_cast<float>(mass / batch.segment_count_);
  units.total_lengths = static_cast<float>(batch.segment_count_);
}

void RodBatchBuilder::set_body(const SegmentDef& s, uint32_t slot, uint32_t i, const RodBatch::Units& units) {
  const SegmentInertia inertia = segment_inertia(s);
  const double mass = inertia.mass_kg / units.mass_kg;
  const double per = 1 / (static_cast<double>(units.mass_kg) * units.length_m * units.length_m);
  put(slot, i, simd::kRodFree, s.fixed ? 0 : 1);
  put(slot, i, simd::kRodMass, mass);
  put(slot, i, simd::kRodInverseMass, s.fixed ? 0 : 1 / mass);
  put(slot, i, simd::kRodInertia, inertia.inertia_kg_m2 * per);
  put(slot, i, simd::kRodAxialInertia, inertia.axial_inertia_kg_m2 * per);
  put(slot, i, simd::kRodHalfLength, 0.5 * s.length_m / units.length_m);
  put(slot, i, simd::kRodDrag, s.drag_per_s);
}

void RodBatchBuilder::set_joint(const SegmentDef& parent, const SegmentDef& s, uint32_t slot, uint32_t i,
                                const RodBatch::Units& units) {
  const JointCompliance c = joint_compliance(parent, s);
  const double m = units.mass_kg, l = units.length_m, side = batch.joint_side(i);
  const uint32_t at = batch.joint_segments_[i];
  const float upper = parent.length_m, own = s.length_m;
  put(slot, at, simd::kRodStretchCompliance, c.stretch_m_n * m);
  put(slot, at, simd::kRodBendCompliance, c.bend_rad_nm * m * l * l);
  put(slot, at, simd::kRodTwistCompliance, c.twist_rad_nm * m * l * l);
  put(slot, at, simd::kRodDamping, s.damping_s);
  for (uint32_t k = 0; k < RodBatch::kMadeJoint; ++k)
    batch.made_joint(slot, at, k) = batch.at(slot, at, kJointFields[k]);
  put(slot, at, simd::kRodTied, parent.fixed && s.fixed ? 1 : 0);
  put(slot, at, simd::kRodParentArm, 0.5 * side * (side > 0 ? upper : own) / l);
  put(slot, at, simd::kRodArm, 0.5 * side * (side > 0 ? own : upper) / l);
  double rest[3] = {};
  darboux(joint_end(parent), joint_end(s), rest);
  for (uint32_t k = 0; k < 3; ++k) put(slot, at, simd::kRodRest + k, side * rest[k]);
}

void RodBatchBuilder::set_pose(const SegmentDef& s, uint32_t slot, uint32_t i, const RodBatch::Units& units) {
  const JointEnd end = joint_end(s);
  for (uint32_t k = 0; k < 3; ++k) {
    batch.put_place(slot, i, k, (s.position_m[k] - units.origin_m[k]) / units.length_m);
  }
  for (uint32_t k = 0; k < 4; ++k) {
    put(slot, i, simd::kRodTurn + k, end.orientation[k]);
    put(slot, i, simd::kRodTargetTurn + k, end.orientation[k]);
  }
}

void RodBatchBuilder::fill(const StrandDef& strand, uint32_t slot, uint32_t index) {
  const RodBatch::Units& units = batch.units_[index];
  float* lanes = batch.lanes_ + (slot / batch.width_) * simd::kLaneFields * batch.width_;
  for (uint32_t k = 0; k < 3; ++k) {
    lanes[(simd::kLaneGravity + k) * batch.width_ + slot % batch.width_] =
        batch.settings_.gravity_m_s2[k] / units.length_m;
  }
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    const SegmentDef& s = strand.segments[i];
    set_body(s, slot, i, units);
    if (i > 0) set_joint(strand.segments[s.parent], s, slot, i, units);
    set_pose(s, slot, i, units);
  }
}

void RodBatchBuilder::keep_rest(uint32_t strand) {
  float* out = batch.rest_ + size_t{strand} * batch.segment_count_ * RodBatch::kRestNumbers;
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    for (uint32_t k = 0; k < RodBatch::kRestNumbers; ++k) {
      *out++ = batch.at(strand, i, simd::kRodPlace + k);
    }
  }
}

void RodBatchBuilder::keep_radii(const StrandDef& strand, uint32_t slot) {
  for (uint32_t i = 0; i < batch.segment_count_; ++i) batch.radius_m(slot, i) = strand.segments[i].radius_m;
}

}  // namespace sinew::rods
