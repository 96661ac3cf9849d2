// candidate.hpp  What the scheduler knows of an instance, what it answers, and the memory it works in.
#pragma once
#include <cstdint>
#include <limits>
#include <span>

#include "schedule/front.hpp"
#include "schedule/weight_buckets.hpp"

namespace sinew::frame {

inline constexpr float kHold_s = 0.5f;
inline constexpr float kLongestWait_s = 2;
inline constexpr float kStaleness_s = 2;
inline constexpr float kHysteresis = 1.25f, kHoldBonus = 4;
inline constexpr float kTurnShare = 0.1f;

// Why an instance has the level it has.
enum class Reason : uint8_t { kBest, kBudget, kHeld, kTurn };

// A cache line, for there are hundreds and each is looked at several times.
struct alignas(64) Candidate {
  const Front* front = nullptr;  // of its asset
  uint32_t slot = 0;             // ties go to the smaller
  float weight = 0;              // >= 0, finite: what a share of skinning's error matters
  float waited_s = 0;            // since it was last simulated
  float held_s = 0;              // since its level last rose
  float ticks = 0;               // in this step, and what it takes besides as a share of one
  float cost_factor = 1;         // what its ticks take as a multiple of its asset's
  float base_us = 0;             // what it takes in this step if it is not simulated
  float enter_us = 0;        // what its first simulated tick takes beyond a tick, where it makes up for none
  float change_us = 0;       // likewise the first on a finer control graph than it has
  float turn_left_s = 0;     // > 0: what it has came by a turn, and stays so long
  float rate = 0;            // worked out: weight a tick's time
  float planned_us = 0;      // what it takes in this step, by the answer
  uint8_t missed = 0;        // ticks before this step that it makes up for, where makes_up_on
  uint8_t has = 0;           // its level in the last step
  uint8_t graph = 0;         // the control graph it has; 0 is the finest
  uint8_t top = 0;           // the highest it may have now
  bool keeps_level = false;  // no tick in this step: all is as it was
  bool may_refine = true;    // worked out: there are finer control graphs than it has
  uint8_t level = 0;         // the answer, of its front
  Reason reason = Reason::kBudget;

  // Of levels up to what it has.
  float bonus() const noexcept { return held_s < kHold_s ? kHoldBonus : kHysteresis; }
  // To go there from what it has, it changes to a finer control graph. Going down, what it had is not paid
  // for.
  bool refines(uint32_t to_level) const noexcept {
    return has > 0 && to_level > has && front->levels[to_level].graph < graph;
  }
  float refining_us(uint32_t to_level) const noexcept { return refines(to_level) ? change_us : 0; }
  // What a level takes in this step, whole; no more than that where it waits.
  float cost_us(uint32_t of_level) const noexcept {
    if (of_level == 0) return base_us;
    const bool makes_up = missed > 0;
    return front->step_us(of_level, (ticks + (makes_up ? static_cast<float>(missed) : 0)) * cost_factor) +
           (has == 0 && !makes_up ? enter_us : 0) + refining_us(of_level);
  }
  // The next that is bought above one: what a change of graphs makes dearer than a level above it is passed
  // over. Beyond the top: there is none.
  uint32_t next_level(uint32_t above) const noexcept {
    ++above;
    while (may_refine && above <= top && is_undercut(above)) ++above;
    return above;
  }
  bool is_undercut(uint32_t level) const noexcept {
    if (!refines(level) || front->coarser[level] == 0) return false;
    for (uint32_t above = front->coarser[level]; above <= top; ++above)
      if (!refines(above)) return cost_us(above) <= cost_us(level);
    return false;
  }
};
static_assert(sizeof(Candidate) == 64);

// One level of one candidate, bought from the level below.
struct Purchase {
  float key;  // weight x error saved a microsecond
  uint32_t candidate, level;
  double cost_us;
};

// One that waited too long, in the order in which turns are given.
struct Overdue {
  uint64_t order;
  uint32_t candidate;
};

// One that stays what it was: the key of that, and what comes next, which takes `next_us` more at least.
struct Standing {
  double takes_us = 0;  // more than level 0
  float has_key = std::numeric_limits<float>::infinity();
  float next_key = -1, next_us = std::numeric_limits<float>::infinity();  // there is none
};

// Memory of one schedule() after another, taken once.
struct ScheduleScratch {
  WeightBuckets buckets;
  // Each has room for all candidates.
  std::span<Overdue> overdue;
  std::span<Purchase> purchases;
  std::span<uint32_t> open;  // who may go up or down
  std::span<Standing> standings;
  uint32_t lowest = 0;  // fine drawer that was bought of last; where it is looked for first
};

}  // namespace sinew::frame
