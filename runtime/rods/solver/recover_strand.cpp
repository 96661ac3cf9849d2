// recover_strand.cpp  A strand whose numbers are not finite starts anew at rest, where it is held.
#include <cmath>

#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {
namespace {

struct RestPose {
  Vector place;
  Turn turn;
};

// A place is two floats, high and low.
RestPose rest_pose(const float* rest) {
  RestPose out;
  for (size_t k = 0; k < 3; ++k) {
    out.place[k] = static_cast<double>(rest[k]) + static_cast<double>(rest[3 + k]);
  }
  for (size_t k = 0; k < 4; ++k) out.turn[k] = static_cast<double>(rest[6 + k]);
  return out;
}

// As a rigid body that goes from one pose to the other.
RestPose moved_along(const RestPose& own, const RestPose& from, const RestPose& to) {
  const Turn by = normalised(product(to.turn, conjugate(from.turn)));
  const Vector arm =
      turned(by, {own.place[0] - from.place[0], own.place[1] - from.place[1], own.place[2] - from.place[2]});
  return {{to.place[0] + arm[0], to.place[1] + arm[1], to.place[2] + arm[2]},
          normalised(product(by, own.turn))};
}

}  // namespace

bool RodBatch::held(uint32_t strand, uint32_t segment) const noexcept {
  bool finite = at(strand, segment, simd::kRodFree) == 0;
  for (uint32_t k = simd::kRodPlace; k < simd::kRodVelocity; ++k) {
    finite = finite && std::isfinite(at(strand, segment, k));
  }
  return finite;
}

// Motion, forces and targets end where the segment is.
void RodBatch::forget_motion(uint32_t strand, uint32_t segment) noexcept {
  for (uint32_t k = 0; k < 3; ++k) at(strand, segment, simd::kRodTarget + k) = 0;
  for (uint32_t k = 0; k < 4; ++k) {
    at(strand, segment, simd::kRodTargetTurn + k) = at(strand, segment, simd::kRodTurn + k);
  }
  for (uint32_t k = simd::kRodVelocity; k < simd::kRodKeptFields; ++k) at(strand, segment, k) = 0;
}

// Segments whose pose is given stay where they are, the others are put relative to the first of these;
// without one, or where all of them are lost as well, the strand is put where it was created.
void RodBatch::recover(uint32_t strand) noexcept {
  const float* rest = rest_ + size_t{strand} * segment_count_ * kRestNumbers;
  uint32_t first = 0;
  while (first < segment_count_ && !held(strand, first)) ++first;
  RestPose from = rest_pose(rest), to = from;
  if (first < segment_count_) {
    float now[kRestNumbers];
    for (uint32_t k = 0; k < kRestNumbers; ++k) now[k] = at(strand, first, simd::kRodPlace + k);
    from = rest_pose(rest + size_t{first} * kRestNumbers);
    to = rest_pose(now);
  }
  for (uint32_t i = 0; i < segment_count_; ++i) {
    if (!held(strand, i)) {
      const RestPose put = moved_along(rest_pose(rest + size_t{i} * kRestNumbers), from, to);
      for (uint32_t k = 0; k < 3; ++k) put_place(strand, i, k, put.place[k]);
      for (uint32_t k = 0; k < 4; ++k) at(strand, i, simd::kRodTurn + k) = static_cast<float>(put.turn[k]);
    }
    forget_motion(strand, i);
  }
}

}  // namespace sinew::rods
