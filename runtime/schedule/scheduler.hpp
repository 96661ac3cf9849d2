// scheduler.hpp  Which tier each instance gets in this step.
//
// Everything is decided before any work starts, from the numbers below alone: same candidates, same answer.
// Bought is the most of weight x error saved that the budget pays for, on the assets' fronts
// (schedule/front.hpp):
//   1. Every instance's unavoidable cost comes off the budget.
//   2. Turns: one that is not simulated for longer than kLongestWait_s is overdue and gets the cheapest
//   simulated
//      level, the longest wait first; it keeps it for kHold_s. Turns take a kTurnShare of the budget at most,
//      or that of one where more than the whole budget pays for one: they cannot crowd out what matters.
//   3. Levels are bought one by one, most error saved a microsecond first, each counted by its instance's
//   weight x
//      (1 + wait / kStaleness_s). What an instance has already counts kHysteresis times as much, kHoldBonus
//      times in the first kHold_s, so that tiers do not flicker. What does not fit is passed over, as is what
//      takes more in this step than a level above it, for a change of control graphs, and the
//      rest of the budget goes to what fits behind it.
// Longest wait: with n instances of weight > 0, and turns that pay for k of the costliest, none goes
// unsimulated longer than kLongestWait_s + ceil(n / k) (kHold_s + dt). Weight 0 has no turn and gets what is
// left over. Cost: some twenty nanoseconds a candidate in the cache, and the levels of those that may go up
// or down (schedule/buying.hpp); less than sorting all levels
// (half_a_thousand_are_scheduled_sooner_than_their_levels_could_be_sorted); no memory is taken. Where nobody
// has a level yet, what is bought and the best level passed over are together worth the optimum at least
// (what_a_budget_misses_is_less_than_the_best_level_that_was_passed_over).
#pragma once
#include <cstdint>
#include <span>

#include "schedule/candidate.hpp"

namespace sinew::frame {

float sane_importance(float importance) noexcept;  // NaN, negative: 0; infinity: the largest finite

struct ScheduleResult {
  float planned_us = 0;  // what all of it takes
  bool denied = false;   // a budget kept one below its top
};

// Fills in level, planned_us, reason and turn_left_s. budget_us: infinity: the top for all; 0 or less: level
// 0 for all.
ScheduleResult schedule(std::span<Candidate> candidates, float budget_us, ScheduleScratch& scratch) noexcept;

}  // namespace sinew::frame
