// front.hpp  What an asset's tiers cost and how far off they are: the points that are worth buying.
#pragma once
#include <cstdint>
#include <span>

#include "pack/format.hpp"
#include "sinew/types.hpp"

namespace sinew::frame {

// Modes and networks: what is simulated tick by tick.
constexpr bool is_simulated(Tier tier) noexcept { return tier >= Tier::kNetwork; }

// A tier on a control graph, as it was baked or corrected. Level 0 of a front is not simulated: no
// cost, all of the error.
struct Level {
  Tier tier = Tier::kExtrapolate;
  float tick_us = 0;   // a tick
  float error = 1;     // a share of skinning's
  uint32_t graph = 0;  // level of control graphs, 0 the finest
};

inline constexpr uint32_t kMostLevels = 25;  // skinning, and as many points as a pack may hold, and to spare

// Where an error was not measured.
float usual_error(Tier tier) noexcept;
// On a coarser control graph, of what it is on the finest: a little more on each.
float coarser_error(float finest, uint32_t graph) noexcept;

// Cost rises and error falls from level to level, and what an error's unit costs rises too: the lower convex
// hull of cost against error. Publishing, which whatever is displaced takes once a step, is part of what the
// first simulated level costs.
struct Front {
  Level levels[kMostLevels];
  float worth[kMostLevels] = {};       // error saved a microsecond by going from the level below to this one
  uint32_t coarser[kMostLevels] = {};  // the lowest level above it that is on a coarser graph; 0: none
  uint8_t level_at[kTierCount][pack::kMostGraphLevels] = {};  // level_of
  uint32_t count = 1;
  float publish_us = 0;  // a step, of whatever is displaced
  float idle_us = 0;     // a step, of what is not

  uint8_t best() const noexcept { return static_cast<uint8_t>(count - 1); }
  float step_us(uint32_t level, float ticks) const noexcept {  // level > 0
    return publish_us + ticks * levels[level].tick_us;
  }
  // The highest level that costs no more than the tier does; 0 for one that is not simulated.
  uint8_t level_of(Tier tier, uint32_t graph) const noexcept {
    return level_at[static_cast<size_t>(tier)][graph];
  }
};

// Points in any order; those that are no numbers or not simulated are left out, as is what beyond
// kMostLevels.
void make_front(std::span<const Level> points, float publish_us, Front* out) noexcept;

}  // namespace sinew::frame
