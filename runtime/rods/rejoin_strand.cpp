// rejoin_strand.cpp  A strand whose iteration did not end in time is kept together.
#include <algorithm>
#include <cmath>

#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {
namespace {

constexpr double kTorn = 0.5;  // gap over the strand's mean segment

}  // namespace

// What its joints carried is no start for the next step: where what is held cannot be reached it grows by
// each iteration, and what is then let go is thrown. Torn apart, its segments keep their orientations and are
// set end to end from the root, velocities accordingly: so it stays within its length of where it is held
// whatever is done to it. Segments whose pose is given stay; a gap that they leave remains. Returns whether
// it was torn.
bool RodBatch::rejoin(uint32_t strand, float dt_s) noexcept {
  const auto row3 = [&](uint32_t i, uint32_t field) -> Vector {
    return {at(strand, i, field), at(strand, i, field + 1), at(strand, i, field + 2)};
  };
  const auto half_axis = [&](uint32_t i) {
    const Turn q = {at(strand, i, simd::kRodTurn), at(strand, i, simd::kRodTurn + 1),
                    at(strand, i, simd::kRodTurn + 2), at(strand, i, simd::kRodTurn + 3)};
    return turned(q, {0, 0, at(strand, i, simd::kRodHalfLength)});
  };
  const auto joined_place = [&](uint32_t i) {
    const uint32_t parent = parents_[i];
    const Vector a = row3(parent, simd::kRodPlace), low = row3(parent, simd::kRodPlaceLow),
                 z_a = half_axis(parent), z_b = half_axis(i);
    return Vector{a[0] + low[0] + z_a[0] + z_b[0], a[1] + low[1] + z_a[1] + z_b[1],
                  a[2] + low[2] + z_a[2] + z_b[2]};
  };
  double torn = 0;
  for (uint32_t i = 0; i < segment_count_; ++i) {
    for (uint32_t k = simd::kRodStartPush; k < simd::kRodKeptFields; ++k) at(strand, i, k) = 0;
    if (i == 0) continue;
    const Vector joined = joined_place(i), own = row3(i, simd::kRodPlace);
    torn = std::max(torn, std::hypot(joined[0] - own[0], joined[1] - own[1], joined[2] - own[2]));
  }
  if (torn <= kTorn) return false;
  for (uint32_t i = 1; i < segment_count_; ++i) {
    if (at(strand, i, simd::kRodFree) == 0) continue;
    const Vector joined = joined_place(i);
    for (uint32_t k = 0; k < 3; ++k) {
      const double before = static_cast<double>(at(strand, i, simd::kRodPlace + k)) +
                            static_cast<double>(at(strand, i, simd::kRodPlaceLow + k));
      at(strand, i, simd::kRodVelocity + k) +=
          static_cast<float>((joined[k] - before) / static_cast<double>(dt_s));
      put_place(strand, i, k, joined[k]);
    }
  }
  return true;
}

}  // namespace sinew::rods
