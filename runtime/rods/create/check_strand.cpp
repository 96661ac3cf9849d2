// check_strand.cpp  Refuses strands that cannot be simulated, by name and place.
#include <cmath>

#include "core/status.hpp"
#include "rods/strand.hpp"

namespace sinew::rods {
namespace {

constexpr double kLargestGap = 0.01;     // of a segment's length, between it and its parent's end
constexpr float kUnitTolerance = 1e-3f;  // of an orientation's length

struct Place {
  uint32_t strand, segment;
};

Status refuse(Place place, const char* name, double value, const char* mend) {
  const StatusCode code = std::isfinite(value) ? StatusCode::kInvalidArgument : StatusCode::kNotFinite;
  return core::make_status(code, "strand %u, segment %u: %s is %g; %s", place.strand, place.segment, name,
                           value, mend);
}

Status check_above_zero(Place place, const char* name, float value) {
  return value > 0 && std::isfinite(value) ? Status{}
                                           : refuse(place, name, value, "give a finite number above 0");
}

Status check_not_negative(Place place, const char* name, float value) {
  return value >= 0 && std::isfinite(value) ? Status{}
                                            : refuse(place, name, value, "give a finite number, 0 or more");
}

Status check_body(Place place, const SegmentDef& s) {
  Status status = check_above_zero(place, "length_m", s.length_m);
  if (status.ok()) status = check_above_zero(place, "radius_m", s.radius_m);
  if (status.ok()) status = check_above_zero(place, "density_kg_m3", s.density_kg_m3);
  if (status.ok()) status = check_not_negative(place, "drag_per_s", s.drag_per_s);
  return status;
}

Status check_joint(Place place, const SegmentDef& s) {
  Status status = check_above_zero(place, "young_modulus_pa", s.young_modulus_pa);
  if (status.ok()) status = check_above_zero(place, "torsion_modulus_pa", s.torsion_modulus_pa);
  if (status.ok()) status = check_not_negative(place, "damping_s", s.damping_s);
  if (status.ok() && !(s.stretch_modulus_pa > 0)) {
    status = refuse(place, "stretch_modulus_pa", s.stretch_modulus_pa,
                    "give a number above 0, infinity for a rod that does not stretch");
  }
  return status;
}

Status check_pose(Place place, const SegmentDef& s) {
  double square = 0;
  for (const float q : s.orientation) square += static_cast<double>(q) * q;
  for (const double x : s.position_m) {
    if (!std::isfinite(x)) return refuse(place, "position_m", x, "give a finite position");
  }
  const double length = std::sqrt(square);
  return std::fabs(length - 1) <= kUnitTolerance
             ? Status{}
             : refuse(place, "the length of orientation", length, "give a unit quaternion");
}

// Whether following the parents from a segment comes back to it.
bool in_cycle(std::span<const SegmentDef> segments, uint32_t start) {
  uint32_t at = segments[start].parent;
  for (size_t i = 0; i < segments.size() && at < segments.size(); ++i, at = segments[at].parent) {
    if (at == start) return true;
  }
  return false;
}

Status check_parent(Place place, std::span<const SegmentDef> segments) {
  const uint32_t parent = segments[place.segment].parent;
  if (place.segment == 0 || parent < place.segment) {
    return place.segment != 0 || parent == kNoParent
               ? Status{}
               : refuse(place, "the root's parent", parent, "give kNoParent: segment 0 is the root");
  }
  if (parent == kNoParent) {
    return core::make_status(
        StatusCode::kInvalidArgument,
        "strand %u, segment %u: no parent; only segment 0 is a root, so make it a strand "
        "of its own",
        place.strand, place.segment);
  }
  if (parent >= segments.size()) return refuse(place, "parent", parent, "there is no such segment");
  return in_cycle(segments, place.segment)
             ? refuse(place, "parent", parent, "these parents form a cycle: open it")
             : refuse(place, "parent", parent, "list a parent before its children");
}

// End (side 1) or beginning (side -1) of a segment.
void end_of(const SegmentDef& s, double side, double out[3]) {
  const double x = s.orientation[0], y = s.orientation[1], z = s.orientation[2], w = s.orientation[3];
  const double axis[3] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
  for (int k = 0; k < 3; ++k) out[k] = s.position_m[k] + side * 0.5 * s.length_m * axis[k];
}

Status check_gap(Place place, const SegmentDef& parent, const SegmentDef& child) {
  double end[3], begin[3];
  end_of(parent, 1, end);
  end_of(child, -1, begin);
  const double gap = std::hypot(end[0] - begin[0], end[1] - begin[1], end[2] - begin[2]);
  return gap <= kLargestGap * child.length_m
             ? Status{}
             : refuse(place, "the gap in metres to its parent's end", gap, "begin it where the parent ends");
}

Status check_segment(Place place, std::span<const SegmentDef> segments) {
  const SegmentDef& s = segments[place.segment];
  Status status = check_parent(place, segments);
  if (status.ok()) status = check_body(place, s);
  if (status.ok()) status = check_pose(place, s);
  if (place.segment == 0 || !status.ok()) return status;
  status = check_joint(place, s);
  return status.ok() ? check_gap(place, segments[s.parent], s) : status;
}

}  // namespace

Status check_strand(const StrandDef& strand, uint32_t index) noexcept {
  const size_t count = strand.segments.size();
  if (count < 2 || count > kMostSegments) {
    return core::make_status(StatusCode::kInvalidArgument, "strand %u: %zu segments; give 2 to %u", index,
                             count, kMostSegments);
  }
  Status status;
  for (uint32_t i = 0; i < count && status.ok(); ++i) status = check_segment({index, i}, strand.segments);
  return status;
}

}  // namespace sinew::rods
