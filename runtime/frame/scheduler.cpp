// scheduler.cpp  Which tier each instance gets in this step.
#include "frame/scheduler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::frame {
namespace {

enum class Rank { kHolding, kOverdue, kWaiting };

float cost_of(const Candidate& c, Tier tier) noexcept { return c.cost_us[static_cast<size_t>(tier)]; }

Rank rank_of(const Candidate& c) noexcept {
  if (c.on_best && c.held_s < kHold_s) return Rank::kHolding;
  const bool overdue =
      !c.on_best && c.eligible && c.has_best && c.importance > 0 && c.waited_s > kLongestWait_s;
  return overdue ? Rank::kOverdue : Rank::kWaiting;
}

double priority(const Candidate& c) noexcept {
  constexpr double kSmallestCost_us = 1e-3;
  const double staleness = c.on_best ? kHysteresis : 1 + c.waited_s / kStaleness_s;
  return c.importance * staleness / std::max<double>(cost_of(c, c.best), kSmallestCost_us);
}

// A total order, so that the answer does not depend on the sorting algorithm.
bool runs_before(const Candidate& a, const Candidate& b) noexcept {
  const Rank rank_a = rank_of(a), rank_b = rank_of(b);
  if (rank_a != rank_b) return rank_a < rank_b;
  if (rank_a == Rank::kOverdue && a.waited_s != b.waited_s) return a.waited_s > b.waited_s;
  const double priority_a = priority(a), priority_b = priority(b);
  if (priority_a != priority_b) return priority_a > priority_b;
  if (a.waited_s != b.waited_s) return a.waited_s > b.waited_s;
  return a.slot < b.slot;
}

double tick_budget(std::span<const Candidate> candidates, float budget_us) noexcept {
  double left = budget_us;
  for (const Candidate& c : candidates) left -= c.base_us;
  return left;
}

bool chooses(const Candidate& c, float budget_us) noexcept {
  return c.eligible && budget_us > 0 && !c.keeps_tier;
}

// Takes the tier if what is left pays for it.
bool take(Candidate& c, Tier tier, double& left) noexcept {
  if (!(cost_of(c, tier) <= left)) return false;
  left -= cost_of(c, tier);
  c.tier = tier;
  return true;
}

// True when one was denied.
bool hand_out_seats(std::span<Candidate> candidates, float budget_us, double& left) noexcept {
  const double whole = left;
  bool closed = false, denied = false;  // closed: an overdue one does not fit yet
  for (Candidate& c : candidates) {
    if (!chooses(c, budget_us) || !c.has_best) continue;
    if (!closed && take(c, c.best, left)) continue;
    denied = true;
    closed = closed || (rank_of(c) == Rank::kOverdue && cost_of(c, c.best) <= whole);
  }
  return denied;
}

void hand_out_rest(Candidate& c, double& left) noexcept {
  for (const Tier tier : {Tier::kModal, Tier::kSpring}) {
    if (tier != c.best && take(c, tier, left)) return;
  }
}

}  // namespace

float sane_importance(float importance) noexcept {
  return importance > 0 ? std::min(importance, std::numeric_limits<float>::max()) : 0;
}

bool schedule(std::span<Candidate> candidates, float budget_us) noexcept {
  std::sort(candidates.begin(), candidates.end(), runs_before);
  for (Candidate& c : candidates) {
    if (c.keeps_tier && budget_us > 0) continue;
    c.tier = chooses(c, budget_us) ? Tier::kExtrapolate : Tier::kSkinning;
  }
  double left = tick_budget(candidates, budget_us);
  const bool denied = hand_out_seats(candidates, budget_us, left);
  for (Candidate& c : candidates) {
    if (chooses(c, budget_us) && c.tier == Tier::kExtrapolate) hand_out_rest(c, left);
  }
  return denied;
}

}  // namespace sinew::frame
