// change_joint.cpp  Joints stiffer or damped otherwise than they were made.
#include <cmath>
#include <limits>

#include "core/status.hpp"
#include "rods/rod_batch.hpp"
#include "rods/state/joint_fields.hpp"

namespace sinew::rods {
namespace {

struct Place {
  uint32_t strand, segment;
};

Status refuse(Place place, const char* name, float value, const char* mend) {
  const StatusCode code = std::isfinite(value) ? StatusCode::kInvalidArgument : StatusCode::kNotFinite;
  return core::make_status(code, "strand %u, segment %u: %s is %g; %s", place.strand, place.segment, name,
                           static_cast<double>(value), mend);
}

// Denormal numbers are 0 in a step.
bool is_normal(float value) {
  return value >= std::numeric_limits<float>::min() && value <= std::numeric_limits<float>::max();
}

}  // namespace

Status RodBatch::set_joint(uint32_t strand, uint32_t segment, const JointChange& change) noexcept {
  const Place place{strand, segment};
  if (const Status status = check_place(strand, segment); !status.ok()) return status;
  if (segment == 0)
    return core::make_status(StatusCode::kInvalidArgument,
                             "strand %u, segment 0: the root has no joint; give a segment after it", strand);
  if (!(change.stiffness > 0) || !std::isfinite(change.stiffness))
    return refuse(place, "stiffness", change.stiffness, "give a finite number above 0");
  if (!(change.damping >= 0) || !std::isfinite(change.damping))
    return refuse(place, "damping", change.damping, "give a finite number, 0 or more");
  const uint32_t record = joint_segments_[segment];
  const float numbers[kMadeJoint] = {made_joint(strand, record, 0) / change.stiffness,
                                     made_joint(strand, record, 1) / change.stiffness,
                                     made_joint(strand, record, 2) * change.damping};
  if (!is_normal(numbers[0]) || !is_normal(numbers[1]))
    return refuse(place, "stiffness", change.stiffness, "its compliance leaves float's range");
  if (!std::isfinite(numbers[2]))
    return refuse(place, "damping", change.damping, "its damping_s leaves float's range");
  for (uint32_t k = 0; k < kMadeJoint; ++k) at(strand, record, kJointFields[k]) = numbers[k];
  return {};
}

}  // namespace sinew::rods
