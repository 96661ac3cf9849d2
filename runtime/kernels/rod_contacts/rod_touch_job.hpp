// rod_touch_job.hpp  What the kernels work on that find where a group's segments touch an obstacle.
//
// First which segments may touch at all: a strand a lane, in float, in the strand's own units, by distances
// that are never above the true ones. Then when and where these do: in double, in metres, by conservative
// advancement, without fused operations, so that they give the bits of first_touch
// (rods/contacts/find/sweep.hpp) on every target.
#pragma once
#include <cstddef>
#include <cstdint>

namespace sinew::simd {

// Contacts are kept for what comes this near, shares of the radii and of the way.
inline constexpr double kRodNearRadii = 0.25, kRodNearWay = 0.25;
// Capsules are side by side where the squared sine of their angle is below this.
inline constexpr double kRodSideBySide = 0.1;
// Deep, of a segment's radius; end on, of a unit normal along the segment.
inline constexpr double kRodDeep = 0.5, kRodEndOn = 0.7;
// Of conservative advancement: it ends at this gap, over the sum of radii, or after so many moments. Axes
// nearer than the last, over the same, have no direction.
inline constexpr double kRodTouching = 1e-2, kRodMeeting = 1e-6;
inline constexpr int kRodMoments = 32;
// Axes are parallel below this squared sine, and points below this squared length, m^2.
inline constexpr double kRodParallel = 1e-8, kRodNoLength2 = 1e-60;

// What is known of a segment at the step's start, in the strand's units, besides its record.
enum RodReachRow : uint32_t {
  kReachAxis = 0,   // [3] half of it
  kReachTouch = 3,  // how far from its axis it may touch something that stands still
  kReachRadius,     // its own
  kReachFar,        // sum of its coordinates' sizes, which roundings are shares of
  kReachClear,      // what is left of its way before it enters a core
  kReachRows
};

// Of all that a strand may touch: a box, and of obstacles far from all boxes what is left of the way before
// their cores.
enum RodBoxRow : uint32_t { kBoxLow = 0, kBoxHigh = 3, kBoxClear = 6, kBoxRows };

// Of one group; arrays of lanes aligned as RodJob's.
struct RodReachJob {
  const float* records;    // as RodJob's
  const float* scratch;    // the first iterate, later the last
  const float* radii_m;    // [segments][width]
  const float* length_m;   // [width] a strand's unit
  const double* origin_m;  // [3][width] where its places count from
  float* reaches;          // [segments][kReachRows][width]
  float* boxes;            // [kBoxRows][width]
  uint32_t segments;
  uint32_t strands;  // of the group that there are
};

// A sphere (both ends one point) or capsule; its axis' ends go straight from the step's start to its end.
struct RodRound {
  double start_m[2][3], end_m[2][3];
  double radius_m;
  double way_m;                                         // of an end, at most
  double linear_m_s[3], angular_rad_s[3], middle_m[3];  // turns about that point at the step's end
  double dt_s;
};

// As a step begins.
struct RodFlat {
  double point_m[3], normal[3];  // unit vector
  double way_m, turn_rad;        // of the point, and about it, in the step
};

enum RodTouchRow : uint32_t {
  kTouchAlong = 0,   // m from the segment's middle
  kTouchAxis = 1,    // [3] the segment's
  kTouchNormal = 4,  // [3]
  kTouchMove = 7,    // [3] of the obstacle's surface there
  kTouchGap = 10,    // at the step's start
  kTouchDepth,       // the same where it is in penetration then, else 0 or more
  kTouchOpen,        // at the iterate
  kTouchSlip,        // [3] up to there
  kTouchRows = kTouchSlip + 3
};

// Of one segment of a group, bit k of lane k.
struct RodTouches {
  static constexpr size_t kLanes = 16;
  uint32_t touch;  // one contact, told in the rows
  uint32_t other;  // several, or one that is out of the ordinary: side by side, deep and end on, axis on axis
  alignas(64) double rows[kTouchRows][kLanes];
};

// For one width of a group. Lanes are bits of a number for each segment, of those that move freely; the calls
// that find them return whether there are any.
struct RodTouchCalls {
  // Fills reaches and boxes.
  void (*reach)(const RodReachJob& job);
  bool (*near_round)(const RodReachJob& job, const RodRound& round, uint16_t* lanes);
  bool (*near_flat)(const RodReachJob& job, const RodFlat& flat, uint16_t* lanes);
  // Whose way to the iterate may lead into the core of something that near_round has been told of.
  bool (*enter)(const RodReachJob& job, uint16_t* lanes);
  // Of those lanes of a segment.
  void (*touch)(const RodReachJob& job, const RodRound& round, uint32_t segment, uint32_t lanes,
                RodTouches* out);
};

struct RodTouchKernels {
  RodTouchCalls wide;    // groups of 16
  RodTouchCalls narrow;  // groups of 4
};

}  // namespace sinew::simd
