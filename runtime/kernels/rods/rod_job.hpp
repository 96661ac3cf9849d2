// rod_job.hpp  What the rod kernels work on: a group of strands of one shape, a strand a lane.
//
// A group is `width` strands, 4 or 16. A record of rows of `width` floats holds one segment of all
// of them and the joint to its parent; segment 0 is the root and has no joint. Units are a strand's own: its
// mean segment's length and mass, and seconds; joints' forces and compliances are kept free of the time
// step's length. Positions are two floats, whose sum is exact to 1e-14 of what it measures. A segment's own z
// axis runs from its beginning to its end.
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/rods/rod_start_job.hpp"

namespace sinew::simd {

// Of a segment in one step: faster spins are slowed down; and in one iteration: longer steps are shortened.
inline constexpr float kRodLargestSpin_rad = 3, kRodLargestTurn_rad = 0.5f;
// Of a change that an iteration takes, where nothing is touched.
inline constexpr float kRodLargestShare = 8;

enum RodField : uint32_t {
  // Fixed at creation.
  kRodFree = 0,  // 1, or 0 where the pose is given from outside
  kRodMass,
  kRodInverseMass,   // 0 where the pose is given
  kRodInertia,       // about x and y
  kRodAxialInertia,  // about z
  kRodHalfLength,
  kRodDrag,  // 1/s
  // Of the joint to the parent, as all that says joint.
  kRodStretchCompliance,
  kRodBendCompliance,
  kRodTwistCompliance,
  kRodDamping,  // s: force by rate of strain over force by strain
  kRodTied,     // 1 where both ends' poses are given: the joint does nothing
  // Half lengths along z from the parent's middle to the joint and from the joint to this one's; both are
  // negative where the rod was listed from its other end.
  kRodParentArm,
  kRodArm,
  kRodRest,  // [3] 2 Im(conj(q_parent) q) at rest
  // What goes from step to step.
  kRodForce = kRodRest + 3,         // [3]
  kRodTarget = kRodForce + 3,       // [3] where the pose is given: displacement of the coming step
  kRodTargetTurn = kRodTarget + 3,  // [4] and orientation at its end
  kRodPlace = kRodTargetTurn + 4,   // [3]
  kRodPlaceLow = kRodPlace + 3,     // [3]
  kRodTurn = kRodPlaceLow + 3,      // [4] orientation x y z w
  kRodVelocity = kRodTurn + 4,      // [3]
  kRodSpin = kRodVelocity + 3,      // [3] angular velocity along the segment's own axes
  // Where a step starts from: acceleration and angular acceleration (own axes) that the joints give a
  // segment, and the joint's force and moment. A step leaves its own here.
  kRodStartPush = kRodSpin + 3,         // [3]
  kRodStartTwist = kRodStartPush + 3,   // [3]
  kRodStartForce = kRodStartTwist + 3,  // [6]
  kRodKeptFields = kRodStartForce + 6,
  // Of one step, in scratch: where the segment goes without joints, what the joint asks for.
  kRodFreeMove = kRodKeptFields,          // [3] displacement
  kRodFreeTurn = kRodFreeMove + 3,        // [4] orientation
  kRodFreeSpin = kRodFreeTurn + 4,        // [3]
  kRodGap = kRodFreeSpin + 3,             // [3] parent's place less own, at the step's start
  kRodStepRest = kRodGap + 3,             // [3]
  kRodStepCompliance = kRodStepRest + 3,  // [3] stretch, bend, twist
  // The iterate.
  kRodMove = kRodStepCompliance + 3,  // [3]
  kRodNow = kRodMove + 3,             // [4]
  kRodForceNow = kRodNow + 4,         // [6]
  // Of the last iteration.
  kRodImpulse = kRodForceNow + 6,  // [6] momentum residual; then the segment's change
  kRodMiss = kRodImpulse + 6,      // [6] constraint residual; then the change of the joint's force
  kRodLastTurn = kRodMiss + 6,     // [3] rotation that the iteration before asked for
  kRodScratchFields = kRodLastTurn + 3,
  // Of one call, in work.
  kRodAxes = kRodScratchFields,              // [9] own axes in the world
  kRodBend = kRodAxes + 9,                   // [4] orientation against the parent's
  kRodStiffened = kRodBend + 4,              // [2] inertia with geometric stiffness: about x and y, about z
  kRodInertiaFactor = kRodStiffened + 2,     // [21] of the segment with all that hangs on it
  kRodJointFactor = kRodInertiaFactor + 21,  // [21]
  kRodFields = kRodJointFactor + 21
};

inline constexpr uint32_t kRodScratchRows = kRodScratchFields - kRodKeptFields;
inline constexpr uint32_t kRodWorkRows = kRodFields - kRodScratchFields;

// Rows of `width` floats of the group itself.
enum RodLaneField : uint32_t {
  kLaneGravity = 0,                // [3]
  kLaneActive = kLaneGravity + 3,  // 1 while a strand is not converged, 0 afterwards and where there is none
  kLaneHeldMiss,                   // largest gap or bend squared left at joints whose child's pose is given
  kLaneShare,                      // of its change that the iteration before took
  kLaneMoved,                      // by that change, a point on a segment's axis, at most
  kLaneLargestShare,               // that the next may take
  kLaneIterations,
  kLaneKnownSteps,  // how many of the last steps' results a start may use, at most kRodStartKnown + 1
  kLaneResidual,    // what residual() found
  kLaneBroken,      // 1 where a step left something that is not finite
  kLaneGapSquare,   // that it left at a joint that does not stretch, the largest
  kLaneFields
};

// What contacts give a segment, in rows of `width` floats: the lower triangle of a positive 6x6 to be added
// to mass and inertia, then force and moment; three of place, three of rotation along the segment's own axes.
enum RodContactRow : uint32_t { kContactMatrix = 0, kContactForce = 21, kRodContactRows = 27 };

struct RodJob {
  float* records;           // [segments][kRodKeptFields][width], 64-byte aligned (width 4: 16-byte)
  float* scratch;           // [segments][kRodScratchRows][width], aligned alike; from predict to finish
  float* work;              // [segments][kRodWorkRows][width], aligned alike; of one call
  float* lanes;             // [kLaneFields][width], aligned alike
  const uint32_t* parents;  // [segments], each less than its own index; parents[0] is 0
  uint32_t segments;
  float dt_s;
  // How long forces change velocity before these move anything: as long as the step. In a fraction x of one
  // of h it is h (1 + x) / 2 (rods/solver/step_between.cpp).
  float force_s;
  float tolerance_rad;   // converged: no segment turned more in an iteration
  bool start_from_zero;  // else from kRodStart*
  // Null where the group touches nothing; else aligned alike. What is in it is used up by an iteration.
  float* contacts = nullptr;         // [segments][kRodContactRows][width]
  const uint8_t* touched = nullptr;  // [segments] 0 where all rows are zero
};

// For one width of a group. All calls work on every lane; a lane's numbers do not depend on its neighbours'.
struct RodCalls {
  RodStartCalls start;
  // Where segments go without joints, and the first iterate.
  void (*predict)(const RodJob& job);
  // After predict: takes what moved segments in the last step and was no joint's, contacts' forces, into
  // where they go without joints.
  void (*hold_forces)(const RodJob& job);
  // One Newton iteration. Returns how many lanes are not converged.
  uint32_t (*direct)(const RodJob& job);
  // Fills kLaneResidual; the iterate stays.
  void (*residual)(const RodJob& job);
  // Takes the iterate over as the new state.
  void (*finish)(const RodJob& job);
  // Lane k of `to` becomes lanes[k] of `from`, of what direct reads or, once `ended`, of what it came to;
  // below zero it stays as it is. Within one group no lane goes up.
  void (*move_lanes)(const RodJob& from, const RodJob& to, const int8_t* lanes, bool ended);
};

struct RodKernels {
  RodCalls wide;    // groups of 16
  RodCalls narrow;  // groups of 4
};

}  // namespace sinew::simd
