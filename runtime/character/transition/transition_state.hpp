// transition_state.hpp  The way between what is simulated and what is shown, and what is carried on without
// simulation.
//
// "Shown" is what is published, along the axes of the flesh, as is the tail: poses need not be followed to
// carry them on. shown = b u + (1 - b) tail, b rising smoothly from 0 to 1 in kBlendInTicks or more
// (character/transition/blend_pace.hpp). The tail is the displacement shown when simulation was last left,
// carried on with damped velocity and then faded to zero; or, where it rides, what that was off, and shown =
// u + (1 - b) tail, b rising more gently.
#pragma once
#include <cstdint>

#include "character/asset/asset.hpp"
#include "core/arena.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

// In ticks of the asset's rate; at 60 Hz 0.07 s, 0.2 s and 0.33 s.
inline constexpr uint32_t kCarryTicks = 4;  // swings on before the fade begins: by then it is more than half
                                            // as far off as skinning, and soon as far
inline constexpr uint32_t kFadeTicks = 12;  // from there to skinning, at least
inline constexpr uint32_t kLongestFadeTicks = 28;  // of what would else be seen to go
inline constexpr uint32_t kBlendInTicks = 20;  // from that to simulation, when it comes back: by then most
                                               // of the swing of starting from the wrong place has died down
inline constexpr uint32_t kLongestBlendTicks =
    60;  // where that would move something far (character/transition/blend_pace.hpp)
// What was left alone for no longer makes up for it when it comes back (character/transition/catch_up.hpp).
inline constexpr uint32_t kCaughtUpTicks = 2;
// Share of its velocity that a tail keeps each tick: nothing flings, it stands still soon, and then costs
// nothing to publish.
inline constexpr float kCarryDamping = 0.6f;

// Plain bytes, saved and restored as they are.
struct TransitionClock {
  uint32_t tail_ticks = kCarryTicks + kFadeTicks;  // since the tail began
  uint32_t rest_ticks = 0;                         // left in which what comes back begins at rest
  uint32_t from_shown = 0;              // simulation came back from what was shown, and not from rest
  uint32_t seam_ticks = kBlendInTicks;  // since the level changed, at most kBlendInTicks
  float blend_pace = 1;                 // of the last tick: what blend_ticks rose by
  uint32_t hidden_ticks = 0;            // character/rest/hidden.hpp
  uint16_t fade_ticks = kFadeTicks;     // of the tail
  // character/transition/catch_up.hpp: ticks since it was left alone; the tail counts from what is simulated.
  uint16_t missed_ticks = 0, tail_rides = 0;
  uint16_t no_padding = 0;
};

// TransitionState::regained: not simulated since.
inline constexpr uint32_t kRegained = 1, kRegainedNow = 2;

struct TransitionState {
  // State.
  float *tail = nullptr, *tail_velocity = nullptr;  // velocity a tick
  float* shown[2] = {};                             // newest first
  uint32_t* regained =
      nullptr;            // [regions]: a change of level had it again, and it is blended in; kRegainedNow
  float* seam = nullptr;  // laid out as `carried`: what a change of level left, null: one level

  float* level_scratch = nullptr;  // character/transition/change_level.cpp; null: one level
};

void lay_out_state(const Asset& asset, core::Arena& arena, TransitionState& to) noexcept;

}  // namespace sinew::world
