// check_range.cpp  Refuses strands whose numbers, in their own units, become 0 or leave float's range.
#include <cmath>
#include <limits>

#include "core/status.hpp"
#include "rods/create/batch_builder.hpp"
#include "rods/section.hpp"

namespace sinew::rods {
namespace {

Status out_of_range(uint32_t strand, uint32_t segment, const char* what, double value) {
  return core::make_status(
      StatusCode::kInvalidArgument,
      "strand %u, segment %u: %s, in floats, is %g; change its length, radius, density or moduli", strand,
      segment, what, value);
}

// Denormal numbers are 0 in a step.
bool above_zero(double value) {
  return value >= std::numeric_limits<float>::min() && value <= std::numeric_limits<float>::max();
}

}  // namespace

// What a segment must keep in the strand's own units.
struct RodBatchBuilder::Kept {
  uint32_t field;
  const char* name;
};

Status RodBatchBuilder::check_units(const StrandDef& strand, uint32_t index) const {
  const RodBatch::Units& units = batch.units_[index];
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    const SegmentDef& s = strand.segments[i];
    const double mass = segment_inertia(s).mass_kg;
    if (!above_zero(s.length_m)) return out_of_range(index, i, "its length in metres", s.length_m);
    if (!above_zero(mass)) return out_of_range(index, i, "its mass in kg", mass);
  }
  const double force = static_cast<double>(units.mass_kg) * units.length_m, moment = force * units.length_m;
  if (!above_zero(force)) return out_of_range(index, 0, "the strand's mean mass times length", force);
  if (!above_zero(moment)) return out_of_range(index, 0, "the strand's mean mass times length^2", moment);
  for (const float g : batch.settings_.gravity_m_s2) {
    const float own = g / units.length_m;
    if (!std::isfinite(own)) return out_of_range(index, 0, "gravity over the strand's mean length", own);
  }
  return {};
}

Status RodBatchBuilder::check_above_zero(uint32_t strand, uint32_t i, uint32_t record,
                                         std::span<const Kept> kept) const {
  for (const Kept& k : kept) {
    const float value = batch.at(strand, record, k.field);
    if (!above_zero(value)) return out_of_range(strand, i, k.name, value);
  }
  return {};
}

Status RodBatchBuilder::check_joint(const SegmentDef& s, uint32_t strand, uint32_t i) const {
  static constexpr Kept kOfJoint[] = {
      {simd::kRodBendCompliance, "its joint's bending compliance over the strand's mean"},
      {simd::kRodTwistCompliance, "its joint's twisting compliance over the strand's mean"}};
  const uint32_t record = batch.joint_segments_[i];
  const float stretch = batch.at(strand, record, simd::kRodStretchCompliance);
  if (std::isfinite(s.stretch_modulus_pa) && !above_zero(stretch)) {
    return out_of_range(strand, i, "its joint's stretching compliance over the strand's mean", stretch);
  }
  return check_above_zero(strand, i, record, kOfJoint);
}

Status RodBatchBuilder::check_filled(const StrandDef& strand, uint32_t index) const {
  static constexpr Kept kOfBody[] = {{simd::kRodMass, "its mass over the strand's mean"},
                                     {simd::kRodInertia, "its inertia over the strand's mean"},
                                     {simd::kRodAxialInertia, "its axial inertia over the strand's mean"},
                                     {simd::kRodHalfLength, "its half length over the strand's mean"}};
  Status status;
  for (uint32_t i = 0; i < batch.segment_count_ && status.ok(); ++i) {
    status = check_above_zero(index, i, i, kOfBody);
    if (i > 0 && status.ok()) status = check_joint(strand.segments[i], index, i);
  }
  return status;
}

}  // namespace sinew::rods
