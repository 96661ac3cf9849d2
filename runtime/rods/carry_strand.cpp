// carry_strand.cpp  A strand is carried along with a segment whose pose jumps.
#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {

// Everything moves as a rigid body with the given segment; velocities turn along. Targets of other fixed
// segments stay where they are in the world.
void RodBatch::carry(uint32_t strand, uint32_t segment, const SegmentPose& to) noexcept {
  const SegmentPose from = pose(strand, segment);
  const Turn by = product(normalised(turn_of(to.orientation)), conjugate(turn_of(from.orientation)));
  const Units& units = units_[strand];
  for (uint32_t i = 0; i < segment_count_; ++i) {
    const SegmentPose old = pose(strand, i);
    const Vector arm =
        turned(by, {old.position_m[0] - from.position_m[0], old.position_m[1] - from.position_m[1],
                    old.position_m[2] - from.position_m[2]});
    const Vector speed = turned(by, {at(strand, i, simd::kRodVelocity), at(strand, i, simd::kRodVelocity + 1),
                                     at(strand, i, simd::kRodVelocity + 2)});
    const Turn q = normalised(product(by, turn_of(old.orientation)));
    for (uint32_t k = 0; k < 3; ++k) {
      const double place = (to.position_m[k] + arm[k] - units.origin_m[k]) / units.length_m;
      const double before = (old.position_m[k] - units.origin_m[k]) / units.length_m;
      at(strand, i, simd::kRodTarget + k) += static_cast<float>(before - place);
      put_place(strand, i, k, place);
      at(strand, i, simd::kRodVelocity + k) = static_cast<float>(speed[k]);
    }
    for (uint32_t k = 0; k < 4; ++k) at(strand, i, simd::kRodTurn + k) = static_cast<float>(q[k]);
  }
  for (uint32_t k = 0; k < 3; ++k) at(strand, segment, simd::kRodTarget + k) = 0;
  for (uint32_t k = 0; k < 4; ++k) {
    at(strand, segment, simd::kRodTargetTurn + k) = at(strand, segment, simd::kRodTurn + k);
  }
  ++teleported_;
}

}  // namespace sinew::rods
