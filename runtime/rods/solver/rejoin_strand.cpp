// rejoin_strand.cpp  A strand that was torn or drawn out is put together.
#include <algorithm>
#include <cmath>

#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {
namespace {

constexpr double kTorn = 0.5;  // gap over the strand's mean segment

}  // namespace

Vector RodBatch::place(uint32_t strand, uint32_t segment) const noexcept {
  Vector out;
  for (uint32_t k = 0; k < 3; ++k) {
    out[k] = static_cast<double>(at(strand, segment, simd::kRodPlace + k)) +
             static_cast<double>(at(strand, segment, simd::kRodPlaceLow + k));
  }
  return out;
}

// From a segment's middle to its end.
Vector RodBatch::half_axis(uint32_t strand, uint32_t segment) const noexcept {
  const Turn q = {at(strand, segment, simd::kRodTurn), at(strand, segment, simd::kRodTurn + 1),
                  at(strand, segment, simd::kRodTurn + 2), at(strand, segment, simd::kRodTurn + 3)};
  return turned(q, {0, 0, at(strand, segment, simd::kRodHalfLength)});
}

// From the parent's place to where the joint puts the segment's.
Vector RodBatch::joint_offset(uint32_t strand, uint32_t segment) const noexcept {
  const Vector a = half_axis(strand, parents_[segment]), b = half_axis(strand, segment);
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

double RodBatch::largest_gap(uint32_t strand) const noexcept {
  double largest = 0;
  for (uint32_t i = 1; i < segment_count_; ++i) {
    const Vector a = place(strand, parents_[i]), b = place(strand, i), by = joint_offset(strand, i);
    largest = std::max(largest, std::hypot(a[0] + by[0] - b[0], a[1] + by[1] - b[1], a[2] + by[2] - b[2]));
  }
  return largest;
}

// Of each segment, how many joints lie between it and the nearest whose pose is given; counted from the root
// where there is none.
void RodBatch::count_joints_to_held(uint32_t strand, float* joints) const noexcept {
  bool any = false;
  for (uint32_t i = 0; i < segment_count_; ++i) any = any || at(strand, i, simd::kRodFree) == 0;
  const auto farthest = static_cast<float>(segment_count_);
  for (uint32_t i = 0; i < segment_count_; ++i) {
    joints[i] = (any ? at(strand, i, simd::kRodFree) == 0 : i == 0) ? 0 : farthest;
  }
  for (uint32_t i = segment_count_ - 1; i > 0; --i) {
    joints[parents_[i]] = std::min(joints[parents_[i]], joints[i] + 1);
  }
  for (uint32_t i = 1; i < segment_count_; ++i) joints[i] = std::min(joints[i], joints[parents_[i]] + 1);
}

// Of each segment, which is held nearest to it, as rejoin goes out from them, and how far it is along the
// strand, from middle to middle. joints: count_joints_to_held's.
void RodBatch::find_ways(uint32_t strand, const float* joints, float* nearest, float* way) const noexcept {
  for (uint32_t i = 0; i < segment_count_; ++i) nearest[i] = static_cast<float>(i), way[i] = 0;
  const auto half = [&](uint32_t i) { return at(strand, i, simd::kRodHalfLength); };
  const auto go = [&](uint32_t from, uint32_t to) {
    if (joints[to] != joints[from] + 1) return;
    nearest[to] = nearest[from];
    way[to] = way[from] + half(from) + half(to);
  };
  for (uint32_t i = segment_count_ - 1; i > 0; --i) go(i, parents_[i]);
  for (uint32_t i = 1; i < segment_count_; ++i) go(parents_[i], i);
}

// Further than its length allows from what holds it; what may stretch may be. joints: scratch for three
// numbers a segment, the first of which are count_joints_to_held's.
bool RodBatch::is_beyond_reach(uint32_t strand, float* joints) const noexcept {
  float *nearest = joints + segment_count_, *way = nearest + segment_count_;
  find_ways(strand, joints, nearest, way);
  const double spare = (kMostReach - 1) * static_cast<double>(*std::max_element(way, way + segment_count_));
  for (uint32_t i = 0; i < segment_count_; ++i) {
    const auto held = static_cast<uint32_t>(nearest[i]);
    if (at(strand, i, simd::kRodStretchCompliance) > 0 || at(strand, held, simd::kRodFree) != 0) return false;
    const Vector from = place(strand, held), to = place(strand, i);
    const double most = static_cast<double>(way[i]) + spare;
    if (way[i] > 0 && !(std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]) <= most)) return true;
  }
  return false;
}

// Puts a segment somewhere else within a step; its velocity is what took it there.
void RodBatch::shift(uint32_t strand, uint32_t segment, const Vector& to, float dt_s) noexcept {
  const Vector before = place(strand, segment);
  for (uint32_t k = 0; k < 3; ++k) {
    at(strand, segment, simd::kRodVelocity + k) +=
        static_cast<float>((to[k] - before[k]) / static_cast<double>(dt_s));
    put_place(strand, segment, k, to[k]);
  }
}

// What the joints of a strand that did not converge carried is no start for the next step: where what is held
// cannot be reached it grows by each iteration, and what is then let go is thrown.
void RodBatch::forget_start(uint32_t strand) noexcept {
  for (uint32_t i = 0; i < segment_count_; ++i) {
    for (uint32_t k = simd::kRodStartPush; k < simd::kRodKeptFields; ++k) at(strand, i, k) = 0;
  }
}

// Torn apart or drawn out, its segments keep their orientations and are set end to end outwards from what is
// held, from the nearest of several, velocities accordingly: so it stays within its length of where it is
// held whatever is done to it. Between two that are held a gap may remain. Returns whether it was.
bool RodBatch::rejoin(uint32_t strand, bool converged, float dt_s) noexcept {
  float* joints = scratch_;  // free between finish and predict
  count_joints_to_held(strand, joints);
  const bool is_torn = !converged && largest_gap(strand) > kTorn;
  if (!is_torn && !is_beyond_reach(strand, joints)) return false;
  // Children come after their parents: inwards first, so that what turns outwards again stands already.
  for (uint32_t i = segment_count_ - 1; i > 0; --i) {
    const uint32_t parent = parents_[i];
    if (joints[parent] != joints[i] + 1) continue;
    const Vector own = place(strand, i), by = joint_offset(strand, i);
    shift(strand, parent, {own[0] - by[0], own[1] - by[1], own[2] - by[2]}, dt_s);
  }
  for (uint32_t i = 1; i < segment_count_; ++i) {
    if (joints[i] != joints[parents_[i]] + 1) continue;
    const Vector from = place(strand, parents_[i]), by = joint_offset(strand, i);
    shift(strand, i, {from[0] + by[0], from[1] + by[1], from[2] + by[2]}, dt_s);
  }
  return true;
}

}  // namespace sinew::rods
