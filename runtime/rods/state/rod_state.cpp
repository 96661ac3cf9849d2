// rod_state.cpp  A batch's state from outside: saved and restored, put into a pose, turned, given another
// rest shape.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/status.hpp"
#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {
namespace {

// Rows of a record that a batch's life changes.
constexpr uint32_t kFirstKept = simd::kRodRest, kKept = simd::kRodKeptFields - kFirstKept;

Status check_turn(uint32_t strand, uint32_t segment, const Turn& turn) {
  constexpr double kUnitTolerance = 1e-3;
  const double length = norm(turn);
  if (std::isfinite(length) && std::fabs(length - 1) <= kUnitTolerance) return {};
  return core::make_status(std::isfinite(length) ? StatusCode::kInvalidArgument : StatusCode::kNotFinite,
                           "strand %u, segment %u: the rotation's length is %g; give a unit quaternion",
                           strand, segment, length);
}

}  // namespace

// Runs of bytes: a record's rows; of starts that remember steps what they remember.
template <class Run>
void RodBatch::for_each_run(Run run) const noexcept {
  if (strand_count_ == 0) return;
  const size_t groups = (size_t{strand_count_} + width_ - 1) / width_, records = groups * segment_count_;
  for (size_t r = 0; r < records; ++r)
    run(records_ + (r * simd::kRodKeptFields + kFirstKept) * width_, kKept * width_ * sizeof(float));
  if (history_ == nullptr) return;
  for (size_t g = 0; g < groups; ++g)
    run(lanes_ + (g * simd::kLaneFields + simd::kLaneKnownSteps) * width_, width_ * sizeof(float));
  run(history_, records * width_ * simd::kRodStartAges * simd::kRodStartNumbers * sizeof(float));
  if (inputs_ == nullptr) return;
  run(inputs_, records * width_ * simd::kRodStartInputs * sizeof(float));
  run(continued_, records * width_ * simd::kRodStartNumbers * sizeof(float));
  run(scales_, groups * width_ * simd::kRodStartTriples * sizeof(float));
}

size_t RodBatch::state_bytes() const noexcept {
  size_t bytes = sizeof newest_;
  for_each_run([&](const float*, size_t size) { bytes += size; });
  return bytes;
}

void RodBatch::save_state(std::byte* out) const noexcept {
  std::memcpy(out, &newest_, sizeof newest_);
  out += sizeof newest_;
  for_each_run([&](const float* run, size_t size) {
    std::memcpy(out, run, size);
    out += size;
  });
}

void RodBatch::restore_state(const std::byte* from) noexcept {
  std::memcpy(&newest_, from, sizeof newest_);
  from += sizeof newest_;
  for_each_run([&](float* run, size_t size) {
    std::memcpy(run, from, size);
    from += size;
  });
}

Status RodBatch::set_pose(uint32_t strand, uint32_t segment, const SegmentPose& pose,
                          const SegmentVelocity& velocity) noexcept {
  Status status = check_place(strand, segment);
  if (status.ok()) status = check_turn(strand, segment, turn_of(pose.orientation));
  if (!status.ok()) return status;
  const Units& units = units_[strand];
  const Turn turn = normalised(turn_of(pose.orientation));
  const Vector spin = turned_back(turn, vector_of(velocity.angular_rad_s));
  double place[3];
  float speed[3];
  bool finite = true;
  for (size_t k = 0; k < 3; ++k) {
    place[k] = (pose.position_m[k] - units.origin_m[k]) / units.length_m;
    speed[k] = velocity.linear_m_s[k] / units.length_m;
    finite = finite && std::isfinite(static_cast<float>(place[k])) && std::isfinite(speed[k]) &&
             std::isfinite(static_cast<float>(spin[k]));
  }
  if (!finite)
    return core::make_status(
        StatusCode::kNotFinite,
        "strand %u, segment %u: a position or a velocity is not finite, or leaves float's "
        "range over the strand's mean segment; the last one remains in use",
        strand, segment);
  for (uint32_t k = 0; k < 3; ++k) {
    put_place(strand, segment, k, place[k]);
    at(strand, segment, simd::kRodVelocity + k) = speed[k];
    at(strand, segment, simd::kRodSpin + k) = static_cast<float>(spin[k]);
    at(strand, segment, simd::kRodTarget + k) = 0;
  }
  for (uint32_t k = 0; k < 4; ++k) {
    at(strand, segment, simd::kRodTurn + k) = static_cast<float>(turn[k]);
    at(strand, segment, simd::kRodTargetTurn + k) = static_cast<float>(turn[k]);
  }
  for (uint32_t k = simd::kRodStartPush; k < simd::kRodKeptFields; ++k) at(strand, segment, k) = 0;
  known_steps(strand) = 0;
  return {};
}

Status RodBatch::set_rest(uint32_t strand, uint32_t segment, const float (&to_parent)[4]) noexcept {
  Status status = check_place(strand, segment);
  if (status.ok()) status = check_turn(strand, segment, turn_of(to_parent));
  if (!status.ok()) return status;
  if (segment == 0)
    return core::make_status(StatusCode::kInvalidArgument,
                             "strand %u, segment 0: the root has no joint; give a segment after it", strand);
  const Turn turn = normalised(turn_of(to_parent));
  const double twice = (turn[3] < 0 ? -2 : 2) * static_cast<double>(joint_side(segment));
  for (uint32_t k = 0; k < 3; ++k)
    at(strand, joint_segments_[segment], simd::kRodRest + k) = static_cast<float>(twice * turn[k]);
  return {};
}

void RodBatch::turn_all(const Turn& by, const Vector& centre_m) noexcept {
  const Turn turn = normalised(by);
  for (uint32_t strand = 0; strand < strand_count_; ++strand) {
    const Units& units = units_[strand];
    for (uint32_t i = 0; i < segment_count_; ++i) {
      const SegmentPose old = pose(strand, i);
      const Vector arm = turned(turn, {old.position_m[0] - centre_m[0], old.position_m[1] - centre_m[1],
                                       old.position_m[2] - centre_m[2]});
      const Turn q = normalised(product(turn, turn_of(old.orientation)));
      for (uint32_t k = 0; k < 3; ++k) {
        put_place(strand, i, k, (centre_m[k] + arm[k] - units.origin_m[k]) / units.length_m);
        at(strand, i, simd::kRodTarget + k) = 0;
      }
      for (uint32_t k = 0; k < 4; ++k) {
        at(strand, i, simd::kRodTurn + k) = static_cast<float>(q[k]);
        at(strand, i, simd::kRodTargetTurn + k) = static_cast<float>(q[k]);
      }
      for (const uint32_t field :
           {simd::kRodForce, simd::kRodVelocity, simd::kRodStartPush, simd::kRodStartForce})
        turn_row(strand, i, field, turn);
    }
    // Earlier results were not turned along: the next step starts from the last one.
    known_steps(strand) = std::min(known_steps(strand), 1.0f);
  }
}

}  // namespace sinew::rods
