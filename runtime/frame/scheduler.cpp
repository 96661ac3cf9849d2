// scheduler.cpp  Which tier each instance gets in this step.
#include "frame/scheduler.hpp"

#include <algorithm>
#include <limits>

namespace sinew::frame {
namespace {

float staleness(const Candidate& c) noexcept { return 1 + c.waited_s / kStaleness_s; }

// What has no weight comes behind all that has.
void weigh(Candidate& c) noexcept {
  constexpr float kLeast = 1e-30f, kFewest = 1e-3f;
  c.rate = std::max(kLeast, c.weight * staleness(c)) / std::max(kFewest, c.ticks * c.cost_factor);
  c.bonus = c.held_s < kHold_s ? kHoldBonus : kHysteresis;
  c.may_refine = c.has > 0 && c.graph > 0;
}

// Weight x error saved a microsecond.
float key_of(const Candidate& c, uint32_t level) noexcept {
  return c.rate * (level > c.has ? 1 : c.bonus) * c.front->worth[level];
}

// Of a level above the one it has been given: its steps one by one, each as good as the one before at most,
// while they cost no more than `most`. Work(level, key, cost) says whether to go on.
template <class Work>
void for_each_step_up(const Candidate& c, double most, Work work) noexcept {
  float key = std::numeric_limits<float>::max();
  for (uint32_t below = c.level, level = c.next_level(below); level <= c.top; level = c.next_level(level)) {
    const float cost = c.rise_us(below, level);
    if (static_cast<double>(cost) > most) return;
    key = std::min(key, key_of(c, level));
    if (!work(level, key, cost)) return;
    below = level;
  }
}

bool chooses(const Candidate& c) noexcept { return !c.keeps_level && c.top > 0; }

// ---- turns ----

bool is_overdue(const Candidate& c) noexcept {
  if (!chooses(c) || !(c.weight > 0)) return false;
  return c.has > 0 ? c.turn_left_s > 0 : c.waited_s > kLongestWait_s;
}

struct LongerWait {
  std::span<const Candidate> all;
  bool operator()(uint32_t a, uint32_t b) const noexcept {
    const Candidate &x = all[a], &y = all[b];
    if ((x.has > 0) != (y.has > 0)) return x.has > 0;  // a turn that has begun is not broken off
    return x.waited_s != y.waited_s ? x.waited_s > y.waited_s : x.slot < y.slot;
  }
};

// Calls work for each, the longest wait first, until it says no: after a few, and no more are sorted.
template <class Work>
void for_each_by_wait(std::span<uint32_t> overdue, const LongerWait& longer, Work work) noexcept {
  for (size_t few = 8; !overdue.empty(); few *= 8) {
    const auto some = overdue.first(std::min(overdue.size(), few));
    std::partial_sort(overdue.begin(), some.end(), overdue.end(), longer);
    for (const uint32_t candidate : some)
      if (!work(candidate)) return;
    overdue = overdue.subspan(some.size());
  }
}

void hand_out_turns(std::span<Candidate> candidates, std::span<uint32_t> overdue, double& left) noexcept {
  double turns_left = left * static_cast<double>(kTurnShare);
  bool first = true;
  for_each_by_wait(overdue, {candidates}, [&](uint32_t candidate) {
    Candidate& c = candidates[candidate];
    const auto cost = static_cast<double>(c.cost_us(1) - c.cost_us(0));
    if (cost > left) return true;  // dearer than all there is: nobody waits for it
    if (cost > turns_left && !first) return false;
    first = false;
    turns_left -= cost;
    left -= cost;
    if (c.has == 0) c.turn_left_s = kHold_s;
    c.level = 1;
    c.reason = Reason::kTurn;
    return true;
  });
}

// ---- buying ----

struct Dearer {
  std::span<const Candidate> all;
  bool operator()(const Purchase& a, const Purchase& b) const noexcept {
    if (a.key != b.key) return a.key < b.key;
    const uint32_t x = all[a.candidate].slot, y = all[b.candidate].slot;
    return x != y ? x > y : a.level > b.level;
  }
};

// Sums of what lies in the drawers from `lowest` on. False when nothing can be paid for.
bool sum_up(std::span<const Candidate> candidates, double left, uint32_t lowest,
            WeightBuckets& buckets) noexcept {
  buckets.clear();
  bool any = false;
  for (const Candidate& c : candidates) {
    if (!chooses(c)) continue;
    for_each_step_up(c, left, [&](uint32_t, float key, float cost) {
      const uint32_t drawer = WeightBuckets::drawer_of(key);
      any = true;
      if (drawer < lowest) return false;
      buckets.add(drawer, cost);
      return true;
    });
  }
  return any;
}

constexpr uint32_t kNothing = UINT32_MAX;

// What the budget pays for changes little from a step to the next: drawers far below the last step's lowest
// are opened only where those above them leave something.
uint32_t find_lowest(std::span<const Candidate> candidates, double left, ScheduleScratch& scratch,
                     double* rest) noexcept {
  constexpr uint32_t kOctave = 16;
  const uint32_t floor = scratch.lowest > kOctave ? scratch.lowest - kOctave : 0;
  bool any = sum_up(candidates, left, floor, scratch.buckets);
  uint32_t lowest = scratch.buckets.lowest_within(left, rest);
  if (any && floor > 0 && !scratch.buckets.has_below(lowest)) {
    any = sum_up(candidates, left, 0, scratch.buckets);
    lowest = scratch.buckets.lowest_within(left, rest);
  }
  scratch.lowest = lowest;
  return any ? lowest : kNothing;
}

// Takes what lies in the drawers from `lowest` on; gathers the next step of each, where `rest` pays for it.
uint32_t take_above(std::span<Candidate> candidates, double left, uint32_t lowest, double rest,
                    std::span<Purchase> purchases) noexcept {
  uint32_t count = 0;
  for (uint32_t i = 0; i < candidates.size(); ++i) {
    Candidate& c = candidates[i];
    if (!chooses(c)) continue;
    uint32_t reached = c.level;
    for_each_step_up(c, left, [&](uint32_t level, float key, float cost) {
      if (WeightBuckets::drawer_of(key) >= lowest) return reached = level, true;
      if (static_cast<double>(cost) <= rest) purchases[count++] = {key, cost, i, level};
      return false;
    });
    c.level = reached;
  }
  return count;
}

// The next of the same candidate, as good as this one at most. False: there is none.
bool next_of(const Candidate& c, Purchase& purchase) noexcept {
  const uint32_t level = c.next_level(purchase.level);
  if (level > c.top) return false;
  purchase.key = std::min(purchase.key, key_of(c, level));
  purchase.cost_us = c.rise_us(purchase.level, level);
  purchase.level = level;
  return true;
}

// In the order of Dearer, without what is not to be had for `left`.
std::span<Purchase> heap_within(std::span<Purchase> purchases, double left, const Dearer& dearer) noexcept {
  const auto end = std::remove_if(purchases.begin(), purchases.end(),
                                  [&](const Purchase& p) { return static_cast<double>(p.cost_us) > left; });
  std::make_heap(purchases.begin(), end, dearer);
  return {purchases.begin(), end};
}

// What is left over, by the keys themselves.
void take_best(std::span<Candidate> candidates, std::span<Purchase> purchases, double left) noexcept {
  constexpr size_t kSorted = 16;  // as many are sorted again for each that is found to be too dear
  const Dearer dearer{candidates};
  std::span<Purchase> heap = heap_within(purchases, left, dearer);
  for (size_t too_dear = 0; !heap.empty();) {
    std::pop_heap(heap.begin(), heap.end(), dearer);
    Purchase& best = heap.back();
    Candidate& c = candidates[best.candidate];
    const auto cost = static_cast<double>(best.cost_us);
    const bool fits = cost <= left;
    if (fits) left -= cost, c.level = best.level;
    if (fits && next_of(c, best)) {
      std::push_heap(heap.begin(), heap.end(), dearer);
      continue;
    }
    heap = heap.first(heap.size() - 1);
    too_dear += !fits;
    if (too_dear * kSorted > heap.size()) heap = heap_within(heap, left, dearer), too_dear = 0;
  }
}

void buy(std::span<Candidate> candidates, ScheduleScratch& scratch, double left) noexcept {
  double rest = left;
  const uint32_t lowest = find_lowest(candidates, left, scratch, &rest);
  if (lowest == kNothing) return;
  const uint32_t gathered = take_above(candidates, left, lowest, rest, scratch.purchases);
  take_best(candidates, scratch.purchases.first(gathered), rest);
}

// ---- the whole ----

struct Begun {
  double base_us = 0;
  uint32_t overdue = 0;
};

Begun begin(std::span<Candidate> candidates, std::span<uint32_t> overdue) noexcept {
  Begun begun;
  for (uint32_t i = 0; i < candidates.size(); ++i) {
    Candidate& c = candidates[i];
    c.level = c.keeps_level ? c.has : 0;
    c.reason = Reason::kBudget;
    weigh(c);
    begun.base_us += static_cast<double>(c.base_us);
    if (is_overdue(c)) overdue[begun.overdue++] = i;
  }
  return begun;
}

void tell_reason(Candidate& c) noexcept {
  if (c.level == c.top || c.keeps_level)
    c.reason = Reason::kBest;
  else if (c.level > 0 && c.level == c.has && c.held_s < kHold_s && c.reason != Reason::kTurn)
    c.reason = Reason::kHeld;
  if (c.level == 0) c.turn_left_s = 0;
}

ScheduleResult close(std::span<Candidate> candidates) noexcept {
  ScheduleResult result;
  double planned_us = 0;
  for (Candidate& c : candidates) {
    tell_reason(c);
    result.denied |= c.level < c.top && !c.keeps_level;
    planned_us += static_cast<double>(c.keeps_level ? c.base_us : c.cost_us(c.level));
  }
  result.planned_us = static_cast<float>(planned_us);
  return result;
}

}  // namespace

float sane_importance(float importance) noexcept {
  return importance > 0 ? std::min(importance, std::numeric_limits<float>::max()) : 0;
}

ScheduleResult schedule(std::span<Candidate> candidates, float budget_us, ScheduleScratch& scratch) noexcept {
  constexpr float kNoLimit_us = 1e30f;
  const Begun begun = begin(candidates, scratch.overdue);
  double left = static_cast<double>(budget_us) - begun.base_us;
  if (budget_us >= kNoLimit_us) {
    for (Candidate& c : candidates)
      if (chooses(c)) c.level = c.top;
    return close(candidates);
  }
  if (left > 0) {
    hand_out_turns(candidates, scratch.overdue.first(begun.overdue), left);
    buy(candidates, scratch, left);
  }
  return close(candidates);
}

}  // namespace sinew::frame
