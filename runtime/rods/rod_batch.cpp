// rod_batch.cpp  What goes into a batch and comes out of it, in metres and world axes.
#include "rods/rod_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/status.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {
namespace {

constexpr float kUnitTolerance = 1e-3f;

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

Status not_finite(uint32_t strand, uint32_t segment, const char* what) {
  return core::make_status(StatusCode::kNotFinite,
                           "strand %u, segment %u: %s is not finite; the last one remains in use", strand,
                           segment, what);
}

Status too_large(uint32_t strand, uint32_t segment, const char* what) {
  return core::make_status(StatusCode::kInvalidArgument,
                           "strand %u, segment %u: %s, over the strand's mean segment, leaves float's range; "
                           "the last one remains in use",
                           strand, segment, what);
}

Status check_target(uint32_t strand, uint32_t segment, const SegmentPose& pose) {
  bool finite = all_finite(pose.orientation);
  for (const double x : pose.position_m) finite = finite && std::isfinite(x);
  if (!finite) return not_finite(strand, segment, "the pose");
  if (std::fabs(norm(turn_of(pose.orientation)) - 1) <= kUnitTolerance) return {};
  return core::make_status(StatusCode::kInvalidArgument,
                           "strand %u, segment %u: the orientation's length is %g; give a unit quaternion",
                           strand, segment, norm(turn_of(pose.orientation)));
}

Vector over(float unit, const double (&to)[3], const double (&from)[3]) {
  return {(to[0] - from[0]) / unit, (to[1] - from[1]) / unit, (to[2] - from[2]) / unit};
}

double largest_of(const Vector& v) { return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])}); }

}  // namespace

Status RodBatch::check_place(uint32_t strand, uint32_t segment) const noexcept {
  if (strand < strand_count_ && segment < segment_count_) return {};
  return core::make_status(StatusCode::kInvalidArgument,
                           "strand %u, segment %u: the batch has %u strands of %u segments", strand, segment,
                           strand_count_, segment_count_);
}

Status RodBatch::check_simulated(uint32_t strand, uint32_t segment, const char* what) const noexcept {
  const Status status = check_place(strand, segment);
  if (!status.ok() || at(strand, segment, simd::kRodFree) != 0) return status;
  return core::make_status(StatusCode::kInvalidArgument,
                           "strand %u, segment %u: it is fixed and %s would do nothing; give set_target",
                           strand, segment, what);
}

Status RodBatch::set_target(uint32_t strand, uint32_t segment, const SegmentPose& pose) noexcept {
  Status status = check_place(strand, segment);
  if (status.ok()) status = check_target(strand, segment, pose);
  if (!status.ok()) return status;
  if (at(strand, segment, simd::kRodFree) != 0) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "strand %u, segment %u: its pose is simulated; make it fixed to give one",
                             strand, segment);
  }
  const Units& units = units_[strand];
  const SegmentPose now = this->pose(strand, segment);
  const Vector move = over(units.length_m, pose.position_m, now.position_m),
               place = over(units.length_m, pose.position_m, units.origin_m);
  const double largest = std::max(largest_of(move), largest_of(place));
  if (largest > std::numeric_limits<float>::max()) return too_large(strand, segment, "the position");
  if (std::hypot(move[0], move[1], move[2]) >
      static_cast<double>(settings_.teleport_lengths) * units.total_lengths) {
    carry(strand, segment, pose);
  } else {
    put_target(strand, segment, move, normalised(turn_of(pose.orientation)));
  }
  return {};
}

void RodBatch::put_target(uint32_t strand, uint32_t segment, const Vector& move,
                          const Turn& turn) const noexcept {
  for (uint32_t k = 0; k < 3; ++k) at(strand, segment, simd::kRodTarget + k) = static_cast<float>(move[k]);
  for (uint32_t k = 0; k < 4; ++k) {
    at(strand, segment, simd::kRodTargetTurn + k) = static_cast<float>(turn[k]);
  }
}

Status RodBatch::set_force(uint32_t strand, uint32_t segment, const float (&force_n)[3]) noexcept {
  const Status status = check_simulated(strand, segment, "force_n");
  if (!status.ok()) return status;
  if (!all_finite(force_n)) return not_finite(strand, segment, "force_n");
  const float unit = units_[strand].mass_kg * units_[strand].length_m;
  const float own[3] = {force_n[0] / unit, force_n[1] / unit, force_n[2] / unit};
  if (!all_finite(own)) return too_large(strand, segment, "force_n");
  for (uint32_t k = 0; k < 3; ++k) at(strand, segment, simd::kRodForce + k) = own[k];
  return {};
}

Status RodBatch::set_velocity(uint32_t strand, uint32_t segment, const SegmentVelocity& velocity) noexcept {
  const Status status = check_simulated(strand, segment, "the velocity");
  if (!status.ok()) return status;
  if (!all_finite(velocity.linear_m_s) || !all_finite(velocity.angular_rad_s)) {
    return not_finite(strand, segment, "the velocity");
  }
  const Vector spin =
      turned_back(turn_of(pose(strand, segment).orientation), vector_of(velocity.angular_rad_s));
  float own[6];
  for (uint32_t k = 0; k < 3; ++k) {
    own[k] = velocity.linear_m_s[k] / units_[strand].length_m;
    own[3 + k] = static_cast<float>(spin[k]);
  }
  if (!all_finite(own)) return too_large(strand, segment, "the velocity");
  for (uint32_t k = 0; k < 3; ++k) {
    at(strand, segment, simd::kRodVelocity + k) = own[k];
    at(strand, segment, simd::kRodSpin + k) = own[3 + k];
  }
  return {};
}

Status RodBatch::set_start(uint32_t strand, uint32_t segment, const SegmentStart& start) noexcept {
  const Status status = check_place(strand, segment);
  if (!status.ok()) return status;
  if (settings_.start != RodStart::kGiven) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "strand %u, segment %u: this batch reads no start; create it with "
                             "RodSettings::start kGiven",
                             strand, segment);
  }
  if (!all_finite(start.acceleration_m_s2) || !all_finite(start.angular_acceleration_rad_s2) ||
      !all_finite(start.force_n) || !all_finite(start.moment_nm)) {
    return not_finite(strand, segment, "the start");
  }
  const float l = units_[strand].length_m, force = units_[strand].mass_kg * l;
  float own[12];
  for (uint32_t k = 0; k < 3; ++k) {
    own[k] = start.acceleration_m_s2[k] / l;
    own[3 + k] = start.angular_acceleration_rad_s2[k];
    own[6 + k] = start.force_n[k] / force;
    own[9 + k] = start.moment_nm[k] / (force * l);
  }
  if (!all_finite(own)) return too_large(strand, segment, "the start");
  for (uint32_t k = 0; k < 6; ++k) at(strand, segment, simd::kRodStartPush + k) = own[k];
  for (uint32_t k = 0; k < 6 && segment > 0; ++k) {
    at(strand, joint_segments_[segment], simd::kRodStartForce + k) = joint_side(segment) * own[6 + k];
  }
  return {};
}

SegmentPose RodBatch::pose(uint32_t strand, uint32_t segment) const noexcept {
  const Units& units = units_[strand];
  SegmentPose out;
  for (uint32_t k = 0; k < 3; ++k) {
    const double place = static_cast<double>(at(strand, segment, simd::kRodPlace + k)) +
                         static_cast<double>(at(strand, segment, simd::kRodPlaceLow + k));
    out.position_m[k] = units.origin_m[k] + place * units.length_m;
  }
  for (uint32_t k = 0; k < 4; ++k) out.orientation[k] = at(strand, segment, simd::kRodTurn + k);
  return out;
}

SegmentVelocity RodBatch::velocity(uint32_t strand, uint32_t segment) const noexcept {
  SegmentVelocity out;
  Vector own;
  for (uint32_t k = 0; k < 3; ++k) {
    out.linear_m_s[k] = at(strand, segment, simd::kRodVelocity + k) * units_[strand].length_m;
    own[k] = static_cast<double>(at(strand, segment, simd::kRodSpin + k));
  }
  const Vector world = turned(turn_of(pose(strand, segment).orientation), own);
  for (uint32_t k = 0; k < 3; ++k) out.angular_rad_s[k] = static_cast<float>(world[k]);
  return out;
}

SegmentStart RodBatch::last_forces(uint32_t strand, uint32_t segment) const noexcept {
  const float l = units_[strand].length_m, force = units_[strand].mass_kg * l;
  SegmentStart out;
  for (uint32_t k = 0; k < 3; ++k) {
    out.acceleration_m_s2[k] = at(strand, segment, simd::kRodStartPush + k) * l;
    out.angular_acceleration_rad_s2[k] = at(strand, segment, simd::kRodStartTwist + k);
    if (segment == 0) continue;
    const uint32_t joint = joint_segments_[segment];
    out.force_n[k] = joint_side(segment) * at(strand, joint, simd::kRodStartForce + k) * force;
    out.moment_nm[k] = joint_side(segment) * at(strand, joint, simd::kRodStartForce + 3 + k) * (force * l);
  }
  return out;
}

}  // namespace sinew::rods
