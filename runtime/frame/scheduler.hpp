// scheduler.hpp  Which tier each instance gets in this step.
//
// Everything is decided before any work starts, from the numbers below alone: same candidates, same answer.
// First the best tiers are handed out, an asset's network, or its modes where it has none ("a seat"):
//   1. An instance that got a seat keeps it for kHold_s, so that seats do not flicker.
//   2. One that waited longer than kLongestWait_s is overdue and comes next, the longest wait first. While an
//   overdue one does
//      not fit, nobody behind it is let in.
//   3. The others by importance x (1 + wait / kStaleness_s) / cost; those on a seat with a bonus
//   (hysteresis).
// Then, in the same order, those without a seat get the best that what is left pays for: modes, springs, else
// extrapolation.
// Longest wait: with n instances of importance > 0, and a budget for at least k of the costliest beside what
// all of them cost anyway, none waits longer than kLongestWait_s + ceil(n / k) (kHold_s + dt). Importance 0
// gets what is left over.
#pragma once
#include <cstdint>
#include <span>

#include "sinew/types.hpp"

namespace sinew::frame {

inline constexpr float kHold_s = 0.5f;
inline constexpr float kLongestWait_s = 2;
inline constexpr float kStaleness_s = 0.5f;
inline constexpr float kHysteresis = 1.25f;

struct Candidate {
  uint32_t slot = 0;               // ties go to the smaller
  float importance = 0;            // >= 0
  float waited_s = 0;              // since it last had its seat
  float held_s = 0;                // since it got it
  float cost_us[kTierCount] = {};  // by Tier, of a simulated tier in this step
  float base_us = 0;               // what it takes whatever its tier
  Tier best = Tier::kNetwork;      // the seat
  bool on_best = false;
  bool has_best = true;         // false: the seat is not to be had for now, the tiers below are
  bool eligible = true;         // false: fading out after a restart, skinning for now
  bool keeps_tier = false;      // no tick in this step: tier is as before, unless the budget is 0
  Tier tier = Tier::kSkinning;  // the answer
};

float sane_importance(float importance) noexcept;  // NaN, negative: 0; infinity: the largest finite

// Springs, modes and networks: what is simulated tick by tick.
constexpr bool is_simulated(Tier tier) noexcept { return tier >= Tier::kNetwork; }

// Fills in tier and sorts candidates into the order in which they should run. Returns true when a budget
// denied its seat to one. budget_us >= 0; infinity: the best for all that are eligible; 0: skinning for all.
bool schedule(std::span<Candidate> candidates, float budget_us) noexcept;

}  // namespace sinew::frame
