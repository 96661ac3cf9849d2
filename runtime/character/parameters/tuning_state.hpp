// tuning_state.hpp  What an engine changed of an instance, and how far that has come. Plain bytes: saved and
// restored as they are.
#pragma once
#include <cstdint>

#include "sinew/parameters.hpp"

namespace sinew::world {

// A number on its way to what was set: of the last tick, and of the coming one, which is known before so that
// frames between the two lead there (character/parameters/tuning.hpp).
struct Gliding {
  float now = 0, next = 0;
  float speed = 0;  // a tick
};

// Of PartParameters, and of what an instance's and a part's come to together.
inline constexpr float kMostIntensity = 2, kLeastStiffness = 0.01f, kMostStiffness = 100, kMostDamping = 100,
                       kMostDisplacement = 4;

struct SetParameters {  // PartParameters without padding
  float intensity = 1, stiffness = 1, damping = 1, displacement = 1;
  uint32_t enabled = 1;
};

inline constexpr uint32_t kOff = 1, kReturns = 2;  // PartTuning::off

// Of a soft part or a rod.
struct PartTuning {
  SetParameters set;
  uint32_t off = 0;  // it has faded and is left alone; kReturns: from the tick that runs on it is not
  // A limit that opens from 0 frees what swings beneath at its beginning: as a root it opens slowly.
  Gliding intensity{1, 1, 0}, log_stiffness, damping{1, 1, 0}, root_displacement{1, 1, 0};
};

// Of AirState::numbers.
inline constexpr uint32_t kGravityChange = 0, kAcceleration = 3, kWindVelocity = 6, kGust = 9,
                          kAirNumbers = 10;

struct AirState {
  Gliding numbers[kAirNumbers];
  // Of gusts at the root, in the last and the coming tick: their phase (character/parameters/air.cpp).
  double gust_cycles = 0, next_gust_cycles = 0;
  AddedEnvironment added;  // World::set_added_environment
};

// ParameterMarks::tuned: what of it is not as baked. Without a bit nothing of it is looked at.
inline constexpr uint16_t kTunedParts = 1, kTunedAir = 2;

}  // namespace sinew::world
