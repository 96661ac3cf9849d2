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

size_t RodBatch::state_bytes() const noexcept {
  const size_t groups = (strand_count_ + width_ - 1) / std::max(width_, 1u);
  return groups * segment_count_ * kKept * width_ * sizeof(float);
}

void RodBatch::save_state(std::byte* out) const noexcept {
  const size_t run = size_t{kKept} * width_,
               records = strand_count_ == 0 ? 0 : state_bytes() / (run * sizeof(float));
  for (size_t r = 0; r < records; ++r, out += run * sizeof(float))
    std::memcpy(out, records_ + (r * simd::kRodKeptFields + kFirstKept) * width_, run * sizeof(float));
}

void RodBatch::restore_state(const std::byte* from) noexcept {
  const size_t run = size_t{kKept} * width_,
               records = strand_count_ == 0 ? 0 : state_bytes() / (run * sizeof(float));
  for (size_t r = 0; r < records; ++r, from += run * sizeof(float))
    std::memcpy(records_ + (r * simd::kRodKeptFields + kFirstKept) * width_, from, run * sizeof(float));
}

Status RodBatch::place(uint32_t strand, uint32_t segment, const SegmentPose& pose,
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
    return core::make_status(StatusCode::kNotFinite,
                             "strand %u, segment %u: a place or a velocity is not finite, or leaves float's "
                             "range over the strand's mean segment; the last one stays",
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
  const double twice = turn[3] < 0 ? -2 : 2;
  for (uint32_t k = 0; k < 3; ++k)
    at(strand, segment, simd::kRodRest + k) = static_cast<float>(twice * turn[k]);
  return {};
}

void RodBatch::turn_all(const Turn& by, const Vector& centre_m) noexcept {
  const Turn turn = normalised(by);
  const auto turn3 = [&](uint32_t strand, uint32_t i, uint32_t field) {
    const Vector v = turned(turn, {at(strand, i, field), at(strand, i, field + 1), at(strand, i, field + 2)});
    for (uint32_t k = 0; k < 3; ++k) at(strand, i, field + k) = static_cast<float>(v[k]);
  };
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
        turn3(strand, i, field);
    }
  }
}

}  // namespace sinew::rods
