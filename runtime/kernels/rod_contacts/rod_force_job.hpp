// rod_force_job.hpp  What the kernels work on that follow contacts of rods with obstacles, a contact a lane.
//
// In double, in metres, kilograms and kg m (forces times the step's square), operation by operation as
// rods/contacts/solve/contact_forces.cpp, contact_laws.cpp and contact_rows.cpp do it for one contact,
// nothing fused: what a contact comes to has the same bits wherever it is looked at. Lanes that are not asked
// for may hold anything.
#pragma once
#include <cstddef>
#include <cstdint>

namespace sinew::simd {

inline constexpr size_t kForceLanes = 8;
// Of friction's state in a step: a first one mends the guess, a second mends it again with the limit that was
// found; a third takes that back and would go on so.
inline constexpr uint32_t kMostFrictionChanges = 2;
// As rods::Friction has them.
enum RodFriction : uint32_t { kFrictionSticks = 0, kFrictionSlides = 1, kFrictionEither = 2 };

enum RodLookRow : uint32_t {
  kLookNormal = 0,                // [3]
  kLookAxis = kLookNormal + 3,    // [3] the segment's, at the step's start
  kLookObstacle = kLookAxis + 3,  // [3] its move
  kLookGap = kLookObstacle + 3,   // at the step's start
  kLookAllowed,                   // least at its end
  kLookLetsGo,                    // kg: what of the gain a gap counts against a force
  kLookForce,
  kLookOpenBefore,
  kLookAlong,   // from the segment's middle
  kLookRadius,  // signed, along the normal
  kLookLength,  // the strand's unit
  // To be found: how far it is open, and its slip, 0 where it presses neither now nor before.
  kLookOpen,
  kLookSlip,  // [3]
  kLookRows = kLookSlip + 3
};
enum RodLookFloat : uint32_t {
  kLookMove = 0,             // [3] as kRodMove
  kLookNow = kLookMove + 3,  // [4]
  kLookTurn = kLookNow + 4,  // [4] at the step's start
  kLookFloats = kLookTurn + 4
};
struct RodLooks {
  alignas(64) double rows[kLookRows][kForceLanes];
  alignas(64) float floats[kLookFloats][kForceLanes];
};

// Of what was pressed in the last linear system; what an iteration made of it stands in its place.
enum RodTakeRow : uint32_t {
  kTakeGain = 0,
  kTakeFriction,
  kTakeShare,  // of the iteration's change that was taken
  kTakeTolerance,
  kTakeNothing,   // a way that is none
  kTakeRounding,  // kg m: what no iteration closes of a gap, times the gain
  kTakeOpen,
  kTakeOpenBefore,
  kTakeSlip,                        // [3]
  kTakeSlipBefore = kTakeSlip + 3,  // [3]
  kTakeForce = kTakeSlipBefore + 3,
  kTakeLimit,
  kTakeDrag,                   // [3]
  kTakeState = kTakeDrag + 3,  // a RodFriction
  kTakeChanges,
  kTakeMiss,   // of contact's laws, by the forces that the system came to
  kTakeExact,  // 1 where gap and slip are within the tolerance, else 0
  kTakeRows
};
struct RodTakes {
  alignas(64) double rows[kTakeRows][kForceLanes];
};

// Of what presses.
enum RodPushRow : uint32_t {
  kPushGain = 0,
  kPushFriction,
  kPushForce,
  kPushLimit,
  kPushDrag,  // [3]
  kPushState = kPushDrag + 3,
  kPushOpen,
  kPushSlip,                    // [3]
  kPushNormal = kPushSlip + 3,  // [3]
  kPushAlong = kPushNormal + 3,
  kPushRadius,
  kPushStiffness,
  kPushLength,
  kPushMass,
  kPushRows
};
struct RodPushes {
  static constexpr size_t kOut = 27;  // kRodContactRows
  alignas(64) double rows[kPushRows][kForceLanes];
  alignas(64) float now[4][kForceLanes];     // as kRodNow
  alignas(64) float out[kOut][kForceLanes];  // RodContactRow's
};

// Of the first `count` lanes.
struct RodForceKernels {
  void (*look)(RodLooks* looks, size_t count);
  void (*take)(RodTakes* takes, size_t count);
  void (*push)(RodPushes* pushes, size_t count);
};

}  // namespace sinew::simd
