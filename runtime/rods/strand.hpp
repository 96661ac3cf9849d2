// strand.hpp  What a rod is made of, before it is simulated.
#pragma once
#include <cstdint>
#include <limits>
#include <span>

#include "sinew/status.hpp"

namespace sinew::rods {

inline constexpr uint32_t kNoParent = ~0u;
inline constexpr uint32_t kMostSegments = 65536;

// A rigid piece of rod and the joint that holds its beginning to its parent's end. Its own z axis runs from
// its beginning to its end; position is its middle. The pose given here is the shape at rest.
struct SegmentDef {
  double position_m[3] = {0, 0, 0};
  float orientation[4] = {0, 0, 0, 1};  // unit quaternion x y z w: own axes to the world
  float length_m = 0;                   // above 0
  float radius_m = 0;                   // above 0; of a full round section
  float density_kg_m3 = 1000;           // above 0
  uint32_t parent = kNoParent;          // comes before; kNoParent for segment 0 alone
  bool fixed = false;                   // its pose is given (RodBatch::set_target), not simulated
  float drag_per_s = 0;                 // 0 or more: share of its velocity that air takes a second

  // Of the joint to the parent; the root's are not read.
  float young_modulus_pa = 1e6f;    // above 0: against bending
  float torsion_modulus_pa = 1e6f;  // above 0
  // Above 0: against stretch and shear; infinity, the default: neither.
  float stretch_modulus_pa = std::numeric_limits<float>::infinity();
  // 0 or more, s: moment by rate of strain over moment by strain (Kelvin, Voigt). At rest it changes nothing.
  float damping_s = 0;
};

// A chain (each segment's parent is the one before) or a tree.
struct StrandDef {
  std::span<const SegmentDef> segments;
};

// kInvalidArgument or kNotFinite with the strand, the segment, the number and what to do about it. Refused:
// fewer than two segments, numbers outside the ranges above, a parent that is missing, later or in a cycle, a
// segment that begins more than a hundredth of its length from its parent's end. O(n) but for what it
// refuses.
Status check_strand(const StrandDef& strand, uint32_t index) noexcept;

}  // namespace sinew::rods
