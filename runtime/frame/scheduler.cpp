// scheduler.cpp  Which instances get the network in this step.
#include "frame/scheduler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::frame {
namespace {

enum class Rank { kHolding, kOverdue, kWaiting };

Rank rank_of(const Candidate& c) noexcept {
  if (c.on_network && c.held_s < kHold_s) return Rank::kHolding;
  const bool overdue = !c.on_network && c.eligible && c.importance > 0 && c.waited_s > kLongestWait_s;
  return overdue ? Rank::kOverdue : Rank::kWaiting;
}

double priority(const Candidate& c) noexcept {
  constexpr double kSmallestCost_us = 1e-3;
  const double staleness = c.on_network ? kHysteresis : 1 + c.waited_s / kStaleness_s;
  return c.importance * staleness / std::max<double>(c.cost_us, kSmallestCost_us);
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

double network_budget(std::span<const Candidate> candidates, float budget_us) noexcept {
  double left = budget_us;
  for (const Candidate& c : candidates) left -= c.base_us;
  return left;
}

}  // namespace

float sane_importance(float importance) noexcept {
  return importance > 0 ? std::min(importance, std::numeric_limits<float>::max()) : 0;
}

bool schedule(std::span<Candidate> candidates, float budget_us) noexcept {
  std::sort(candidates.begin(), candidates.end(), runs_before);
  const double whole = network_budget(candidates, budget_us);
  double left = whole;
  bool closed = false, denied = false;  // closed: an overdue one does not fit yet
  for (Candidate& c : candidates) {
    if (c.keeps_tier && budget_us > 0) continue;
    c.tier = Tier::kSkinning;
    if (!c.eligible || !(budget_us > 0)) continue;
    const bool fits = c.cost_us <= left && !closed;
    c.tier = fits ? Tier::kNetwork : Tier::kExtrapolate;
    if (fits)
      left -= c.cost_us;
    else
      denied = true;
    closed = closed || (!fits && rank_of(c) == Rank::kOverdue && c.cost_us <= whole);
  }
  return denied;
}

}  // namespace sinew::frame
