// carry_strand.cpp  A strand is carried along with a segment whose pose jumps.
#include <algorithm>

#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {

// A vector along the world's axes.
void RodBatch::turn_row(uint32_t strand, uint32_t segment, uint32_t field, const Turn& by) noexcept {
  const Vector v = turned(
      by, {at(strand, segment, field), at(strand, segment, field + 1), at(strand, segment, field + 2)});
  for (uint32_t k = 0; k < 3; ++k) at(strand, segment, field + k) = static_cast<float>(v[k]);
}

// A target is told from where a segment is: it stays where it is in the world.
void RodBatch::carry_place(uint32_t strand, uint32_t segment, const Turn& by, const SegmentPose& from,
                           const SegmentPose& to) noexcept {
  const SegmentPose old = pose(strand, segment);
  const Units& units = units_[strand];
  const Vector arm =
      turned(by, {old.position_m[0] - from.position_m[0], old.position_m[1] - from.position_m[1],
                  old.position_m[2] - from.position_m[2]});
  for (uint32_t k = 0; k < 3; ++k) {
    const double place = (to.position_m[k] + arm[k] - units.origin_m[k]) / units.length_m;
    const double before = (old.position_m[k] - units.origin_m[k]) / units.length_m;
    at(strand, segment, simd::kRodTarget + k) += static_cast<float>(before - place);
    put_place(strand, segment, k, place);
  }
  const Turn q = normalised(product(by, turn_of(old.orientation)));
  for (uint32_t k = 0; k < 4; ++k) at(strand, segment, simd::kRodTurn + k) = static_cast<float>(q[k]);
}

// Everything moves as a rigid body with the given segment; velocities and what a step starts from turn along.
// Targets of other fixed segments, and forces given from outside, stay as they are in the world.
void RodBatch::carry(uint32_t strand, uint32_t segment, const SegmentPose& to) noexcept {
  const SegmentPose from = pose(strand, segment);
  const Turn by = product(normalised(turn_of(to.orientation)), conjugate(turn_of(from.orientation)));
  for (uint32_t i = 0; i < segment_count_; ++i) {
    carry_place(strand, i, by, from, to);
    for (const uint32_t field : {simd::kRodVelocity, simd::kRodStartPush, simd::kRodStartForce}) {
      turn_row(strand, i, field, by);
    }
  }
  for (uint32_t k = 0; k < 3; ++k) at(strand, segment, simd::kRodTarget + k) = 0;
  for (uint32_t k = 0; k < 4; ++k) {
    at(strand, segment, simd::kRodTargetTurn + k) = at(strand, segment, simd::kRodTurn + k);
  }
  // Earlier results were not turned along: the next step starts from the last one.
  known_steps(strand) = std::min(known_steps(strand), 1.0f);
  ++teleported_;
}

}  // namespace sinew::rods
