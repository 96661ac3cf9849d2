// create_batch.cpp  Checks strands and settings, then lays a batch out and fills it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/arena.hpp"
#include "core/status.hpp"
#include "rods/constraints.hpp"
#include "rods/rod_batch.hpp"
#include "rods/section.hpp"

namespace sinew::rods {
namespace {

constexpr uint32_t kWide = 16, kNarrow = 4;

Status bad_setting(const char* name, double value, const char* range) {
  return core::make_status(StatusCode::kInvalidArgument, "RodSettings::%s is %g; give %s", name, value,
                           range);
}

Status check_settings(const RodSettings& s) {
  if (s.solver > RodSolver::kCg)
    return bad_setting("solver", static_cast<double>(s.solver), "kDirect or kCg");
  if (!(s.cg_tolerance >= 1e-7f && s.cg_tolerance <= 1)) {
    return bad_setting("cg_tolerance", static_cast<double>(s.cg_tolerance), "1e-7 to 1");
  }
  if (s.cg_max_iterations < 1 || s.cg_max_iterations > 100000) {
    return bad_setting("cg_max_iterations", s.cg_max_iterations, "1 to 100000");
  }
  if (s.start > RodStart::kGiven) {
    return bad_setting("start", static_cast<double>(s.start), "kZero, kPrevious or kGiven");
  }
  if (s.max_iterations < 1 || s.max_iterations > 1000) {
    return bad_setting("max_iterations", s.max_iterations, "1 to 1000");
  }
  if (!(s.tolerance_rad >= 1e-6f && s.tolerance_rad <= 1)) {
    return bad_setting("tolerance_rad", static_cast<double>(s.tolerance_rad), "1e-6 to 1");
  }
  if (!(s.teleport_lengths > 0 && std::isfinite(s.teleport_lengths))) {
    return bad_setting("teleport_lengths", static_cast<double>(s.teleport_lengths),
                       "a finite number above 0");
  }
  for (const float g : s.gravity_m_s2) {
    if (!std::isfinite(g)) return bad_setting("gravity_m_s2", static_cast<double>(g), "finite numbers");
  }
  return {};
}

Status check_shape(const StrandDef& first, const StrandDef& strand, uint32_t index) {
  if (strand.segments.size() != first.segments.size()) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "strand %u: %zu segments where strand 0 has %zu; put it into another batch",
                             index, strand.segments.size(), first.segments.size());
  }
  for (size_t i = 1; i < first.segments.size(); ++i) {
    if (strand.segments[i].parent != first.segments[i].parent) {
      return core::make_status(StatusCode::kInvalidArgument,
                               "strand %u, segment %zu: its parent is %u where strand 0 has %u; put it into "
                               "another batch",
                               index, i, strand.segments[i].parent, first.segments[i].parent);
    }
  }
  return {};
}

Status check_all(std::span<const StrandDef> strands, const RodSettings& settings) {
  Status status = check_settings(settings);
  if (status.ok() && strands.empty()) {
    status = core::make_status(StatusCode::kInvalidArgument, "no strand; give one or more");
  }
  for (uint32_t i = 0; i < strands.size() && status.ok(); ++i) {
    status = check_strand(strands[i], i);
    if (status.ok()) status = check_shape(strands[0], strands[i], i);
  }
  return status;
}

JointEnd joint_end(const SegmentDef& s) {
  JointEnd end = {{s.position_m[0], s.position_m[1], s.position_m[2]}, {}, s.length_m};
  double square = 0;
  for (const float q : s.orientation) square += static_cast<double>(q) * q;
  for (int k = 0; k < 4; ++k) end.orientation[k] = s.orientation[k] / std::sqrt(square);
  return end;
}

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

// What a segment must keep in the strand's own units.
struct Kept {
  uint32_t field;
  const char* name;
};
constexpr Kept kOfBody[] = {{simd::kRodMass, "its mass over the strand's mean"},
                            {simd::kRodInertia, "its inertia over the strand's mean"},
                            {simd::kRodAxialInertia, "its axial inertia over the strand's mean"},
                            {simd::kRodHalfLength, "its half length over the strand's mean"}};
constexpr Kept kOfJoint[] = {
    {simd::kRodBendCompliance, "its joint's bending compliance over the strand's mean"},
    {simd::kRodTwistCompliance, "its joint's twisting compliance over the strand's mean"}};

}  // namespace

// Fills one batch; a friend, so that the class shows only what a user calls.
struct RodBatchBuilder {
  RodBatch& batch;

  size_t groups() const { return (batch.strand_count_ + batch.width_ - 1) / batch.width_; }

  void lay_out(std::byte* base, size_t* bytes) {
    core::Arena arena(base);
    const size_t rows = groups() * batch.segment_count_ * simd::kRodKeptFields;
    batch.records_ = arena.take<float>(rows * batch.width_);
    batch.scratch_ = arena.take<float>(size_t{batch.segment_count_} *
                                       (simd::kRodFields - simd::kRodKeptFields) * batch.width_);
    batch.lanes_ = arena.take<float>(groups() * simd::kLaneFields * batch.width_);
    batch.rest_ =
        arena.take<float>(size_t{batch.strand_count_} * batch.segment_count_ * RodBatch::kRestNumbers);
    batch.units_ = arena.take<RodBatch::Units>(batch.strand_count_);
    batch.parents_ = arena.take<uint32_t>(batch.segment_count_);
    *bytes = arena.used_bytes();
  }

  void set_units(const StrandDef& strand, uint32_t index) {
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

  void set_body(const SegmentDef& s, uint32_t slot, uint32_t i, const RodBatch::Units& units) {
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

  void set_joint(const SegmentDef& parent, const SegmentDef& s, uint32_t slot, uint32_t i,
                 const RodBatch::Units& units) {
    const JointCompliance c = joint_compliance(parent, s);
    const double m = units.mass_kg, l = units.length_m;
    put(slot, i, simd::kRodStretchCompliance, c.stretch_m_n * m);
    put(slot, i, simd::kRodBendCompliance, c.bend_rad_nm * m * l * l);
    put(slot, i, simd::kRodTwistCompliance, c.twist_rad_nm * m * l * l);
    put(slot, i, simd::kRodDamping, s.damping_s);
    put(slot, i, simd::kRodTied, parent.fixed && s.fixed ? 1 : 0);
    double rest[3] = {};
    darboux(joint_end(parent), joint_end(s), rest);
    for (uint32_t k = 0; k < 3; ++k) put(slot, i, simd::kRodRest + k, rest[k]);
  }

  void set_pose(const SegmentDef& s, uint32_t slot, uint32_t i, const RodBatch::Units& units) {
    const JointEnd end = joint_end(s);
    for (uint32_t k = 0; k < 3; ++k) {
      batch.put_place(slot, i, k, (s.position_m[k] - units.origin_m[k]) / units.length_m);
    }
    for (uint32_t k = 0; k < 4; ++k) {
      put(slot, i, simd::kRodTurn + k, end.orientation[k]);
      put(slot, i, simd::kRodTargetTurn + k, end.orientation[k]);
    }
  }

  // Of the strand's units, before they divide.
  Status check_units(const StrandDef& strand, uint32_t index) const {
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

  Status check_above_zero(uint32_t strand, uint32_t i, std::span<const Kept> kept) const {
    for (const Kept& k : kept) {
      const float value = batch.at(strand, i, k.field);
      if (!above_zero(value)) return out_of_range(strand, i, k.name, value);
    }
    return {};
  }

  Status check_joint(const SegmentDef& s, uint32_t strand, uint32_t i) const {
    const float stretch = batch.at(strand, i, simd::kRodStretchCompliance);
    if (std::isfinite(s.stretch_modulus_pa) && !above_zero(stretch)) {
      return out_of_range(strand, i, "its joint's stretching compliance over the strand's mean", stretch);
    }
    return check_above_zero(strand, i, kOfJoint);
  }

  // Of what fill() left of a strand.
  Status check_filled(const StrandDef& strand, uint32_t index) const {
    Status status;
    for (uint32_t i = 0; i < batch.segment_count_ && status.ok(); ++i) {
      status = check_above_zero(index, i, kOfBody);
      if (i > 0 && status.ok()) status = check_joint(strand.segments[i], index, i);
    }
    return status;
  }

  // `slot` may lie behind the last strand: lanes that nobody looks at repeat the first strand's numbers.
  void fill(const StrandDef& strand, uint32_t slot, uint32_t index) {
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

  void keep_rest(uint32_t strand) {
    float* out = batch.rest_ + size_t{strand} * batch.segment_count_ * RodBatch::kRestNumbers;
    for (uint32_t i = 0; i < batch.segment_count_; ++i) {
      for (uint32_t k = 0; k < RodBatch::kRestNumbers; ++k) {
        *out++ = batch.at(strand, i, simd::kRodPlace + k);
      }
    }
  }

  void put(uint32_t slot, uint32_t segment, uint32_t field, double value) {
    batch.at(slot, segment, field) = static_cast<float>(value);
  }
};

size_t RodBatch::memory_bytes(uint32_t strands, uint32_t segments) noexcept {
  RodBatch measured;
  measured.strand_count_ = strands;
  measured.segment_count_ = segments;
  measured.width_ = strands > kNarrow ? kWide : kNarrow;
  size_t bytes = 0;
  RodBatchBuilder{measured}.lay_out(nullptr, &bytes);
  return bytes;
}

Status RodBatch::create(std::span<const StrandDef> strands, const RodSettings& settings,
                        RodBatch* out) noexcept {
  Status status = check_all(strands, settings);
  if (!status.ok()) return status;
  RodBatch made;
  RodBatchBuilder builder{made};
  made.settings_ = settings;
  made.strand_count_ = static_cast<uint32_t>(strands.size());
  made.segment_count_ = static_cast<uint32_t>(strands[0].segments.size());
  made.width_ = strands.size() > kNarrow ? kWide : kNarrow;
  size_t bytes = 0;
  builder.lay_out(nullptr, &bytes);
  made.memory_ = core::AlignedBlock(bytes);
  if (!made.memory_.data()) {
    return core::make_status(StatusCode::kOutOfCapacity, "no memory for %zu bytes of rods; make fewer",
                             bytes);
  }
  builder.lay_out(made.memory_.data(), &bytes);
  for (uint32_t i = 1; i < made.segment_count_; ++i) made.parents_[i] = strands[0].segments[i].parent;
  for (uint32_t i = 0; i < made.strand_count_ && status.ok(); ++i) {
    builder.set_units(strands[i], i);
    status = builder.check_units(strands[i], i);
  }
  for (uint32_t slot = 0; status.ok() && slot < builder.groups() * made.width_; ++slot) {
    const uint32_t strand = slot < made.strand_count_ ? slot : 0;
    builder.fill(strands[strand], slot, strand);
    if (slot >= made.strand_count_) continue;
    builder.keep_rest(slot);
    status = builder.check_filled(strands[slot], slot);
  }
  if (status.ok()) *out = static_cast<RodBatch&&>(made);
  return status;
}

}  // namespace sinew::rods
