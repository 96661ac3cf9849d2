// recover_strand.cpp  A strand whose numbers are not finite starts anew at rest, where it is held.
#include <algorithm>
#include <cmath>

#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {
namespace {

struct RestPose {
  Vector place;
  Turn turn;
};

RestPose rest_pose(const float* rest) {
  return {{rest[0], rest[1], rest[2]}, {rest[3], rest[4], rest[5], rest[6]}};
}

}  // namespace

// The first fixed segment stays where it is; without one, or where it is lost as well, the strand is put
// where it was created.
void RodBatch::recover(uint32_t strand) noexcept {
  const float* rest = rest_ + size_t{strand} * segment_count_ * 7;
  uint32_t held = 0;
  while (held < segment_count_ && at(strand, held, simd::kRodFree) != 0) ++held;
  RestPose from = rest_pose(rest), to = from;
  if (held < segment_count_) {
    from = rest_pose(rest + size_t{held} * 7);
    RestPose now;
    double sum = 0;
    for (uint32_t k = 0; k < 3; ++k) sum += now.place[k] = at(strand, held, simd::kRodPlace + k);
    for (uint32_t k = 0; k < 4; ++k) sum += now.turn[k] = at(strand, held, simd::kRodTurn + k);
    to = std::isfinite(sum) ? now : from;
  }
  const Turn by = product(to.turn, conjugate(from.turn));
  for (uint32_t i = 0; i < segment_count_; ++i) {
    const RestPose own = rest_pose(rest + size_t{i} * 7);
    const Vector arm = turned(
        by, {own.place[0] - from.place[0], own.place[1] - from.place[1], own.place[2] - from.place[2]});
    const Turn q = normalised(product(by, own.turn));
    for (uint32_t field = simd::kRodTarget; field < simd::kRodKeptFields; ++field) at(strand, i, field) = 0;
    for (uint32_t k = 0; k < 3; ++k) {
      at(strand, i, simd::kRodPlace + k) = static_cast<float>(to.place[k] + arm[k]);
    }
    for (uint32_t k = 0; k < 4; ++k) {
      at(strand, i, simd::kRodTurn + k) = at(strand, i, simd::kRodTargetTurn + k) = static_cast<float>(q[k]);
    }
  }
}

}  // namespace sinew::rods
