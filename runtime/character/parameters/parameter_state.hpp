// parameter_state.hpp  What an engine changed of an instance between steps, and the numbers that follow from
// it.
#pragma once
#include <cstdint>

#include "character/asset/asset.hpp"
#include "character/parameters/tuning_state.hpp"
#include "core/arena.hpp"
#include "sinew/types.hpp"
#include "tissue/frames/fraction_step.hpp"
#include "tissue/modes/retuned.hpp"

namespace sinew::world {

// Plain bytes, saved and restored as they are.
struct ParameterMarks {
  AirState air;                   // character/parameters/air.hpp
  SetParameters all;              // World::set_parameters
  uint16_t tuned = 0, moves = 0;  // character/parameters/tuning.hpp: of what; something glides or blows
};

// A region's recurrences beside its modes', where they are not the baked ones. Made from the state.
struct TunedRegion {
  bool on = false;
  float stiffens = 0;  // what its modes were made with
  tissue::Recurrence rest, first;
  float rest_gain = 0;
};

struct ParameterState {
  float most_m_s2 = 0;                       // TeleportDef::acceleration, in metres; as by default until set
  float sleep_tolerance = 0;                 // WorldDef::sleep_tolerance, likewise
  const Environment* environment = nullptr;  // the world's; null: as by default

  // State.
  PartTuning *region_tunings = nullptr, *rod_tunings = nullptr;  // [regions], [rods]

  // What follows from these, of the level that it has; looked at where ParameterMarks::tuned has kTunedParts.
  pack::ModeRecord* tuned_modes = nullptr;      // [modes]
  tissue::SwingSlopes* tuned_slopes = nullptr;  // as GraphLevel::swing_slopes
  TunedRegion* tuned_regions = nullptr;         // [regions]
};

void lay_out_state(const Asset& asset, core::Arena& arena, ParameterState& to) noexcept;
void lay_out_scratch(const Asset& asset, core::Arena& arena, ParameterState& to) noexcept;
// As baked, in memory that was laid out.
void begin(const Asset& asset, ParameterState& to) noexcept;

}  // namespace sinew::world
