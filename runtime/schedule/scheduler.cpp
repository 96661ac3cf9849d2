// scheduler.cpp  Which tier each instance gets in this step.
#include "schedule/scheduler.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "schedule/buying.hpp"

namespace sinew::frame {
namespace {

// ---- turns ----

// Calls work for each, the longest wait first, until it says no: after a few, and no more are sorted.
template <class Work>
void for_each_by_wait(std::span<Overdue> overdue, Work work) noexcept {
  for (size_t few = 8; !overdue.empty(); few *= 8) {
    const auto some = overdue.first(std::min(overdue.size(), few));
    std::ranges::partial_sort(overdue, some.end(), {}, &Overdue::order);
    for (const Overdue& next : some)
      if (!work(next.candidate)) return;
    overdue = overdue.subspan(some.size());
  }
}

void hand_out_turns(std::span<Candidate> candidates, std::span<Overdue> overdue, Buying& buying,
                    double& left) noexcept {
  double turns_left = left * static_cast<double>(kTurnShare);
  bool first = true;
  for_each_by_wait(overdue, [&](uint32_t candidate) {
    Candidate& c = candidates[candidate];
    const auto cost = static_cast<double>(c.cost_us(1) - c.cost_us(0));
    if (cost > left) return true;  // dearer than all there is: nobody waits for it
    if (cost > turns_left && !first) return false;
    first = false;
    turns_left -= cost;
    left -= cost;
    if (c.has == 0) c.turn_left_s = kHold_s;
    buying.give_turn(candidate);
    return true;
  });
}

// ---- the whole ----

void tell_reason(Candidate& c) noexcept {
  const bool best = (c.level == c.top) | c.keeps_level;
  const bool held = (c.level > 0) & (c.level == c.has) & (c.held_s < kHold_s) & (c.reason != Reason::kTurn);
  const Reason reasons[] = {c.reason, Reason::kHeld, Reason::kBest, Reason::kBest};
  c.reason = reasons[2 * best + held];  // hard to foretell, and so no branch
  if (c.turn_left_s > 0 && c.level == 0) c.turn_left_s = 0;
}

ScheduleResult close(std::span<Candidate> candidates) noexcept {
  ScheduleResult result;
  double planned_us = 0;
  for (Candidate& c : candidates) {
    tell_reason(c);
    result.denied |= (c.level < c.top) & !c.keeps_level;
    planned_us += static_cast<double>(c.planned_us);
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
  Buying buying(candidates, scratch);
  const Asked asked = buying.ask_all();
  double left = static_cast<double>(budget_us) - asked.base_us;
  if (budget_us >= kNoLimit_us) {
    buying.buy_all();
  } else if (left > 0) {
    hand_out_turns(candidates, scratch.overdue.first(asked.overdue), buying, left);
    buying.buy(left);
  } else {
    buying.buy_nothing();
  }
  return close(candidates);
}

}  // namespace sinew::frame
