// scheduler.hpp  Which instances get the network in this step.
//
// Everything is decided before any work starts, from the numbers below alone: same candidates, same answer.
//   1. An instance that got the network keeps it for kHold_s: starting again costs a blend, so seats do not
//   flicker.
//   2. One that waited longer than kLongestWait_s is overdue and comes next, the longest wait first. While an
//   overdue one does
//      not fit, nobody behind it is let in.
//   3. The others by importance x (1 + wait / kStaleness_s) / cost; those on the network with a bonus
//   (hysteresis).
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
  uint32_t slot = 0;     // ties go to the smaller
  float importance = 0;  // >= 0
  float waited_s = 0;    // since it last had the network
  float held_s = 0;      // since it got it
  float cost_us = 0;     // of the network in this step
  float base_us = 0;     // what it takes whatever its tier
  bool on_network = false;
  bool eligible = true;         // false: fading out after a restart, skinning for now
  bool keeps_tier = false;      // no tick in this step: tier is as before, unless the budget is 0
  Tier tier = Tier::kSkinning;  // the answer
};

float sane_importance(float importance) noexcept;  // NaN, negative: 0; infinity: the largest finite

// Fills in tier and sorts candidates into the order in which they should run. Returns true when a budget
// denied the network to one. budget_us >= 0; infinity: the network for all that are eligible; 0: skinning for
// all.
bool schedule(std::span<Candidate> candidates, float budget_us) noexcept;

}  // namespace sinew::frame
