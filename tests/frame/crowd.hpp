// crowd.hpp  Candidates that share an asset's front, for tests of the scheduler.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "schedule/scheduler.hpp"

namespace sinew::test {

inline constexpr float kCoarse_us = 1, kModal_us = 4, kNetwork_us = 10;

inline frame::Front usual_front(float publish_us = 0) {
  const frame::Level points[] = {{.tier = Tier::kModal, .tick_us = kCoarse_us, .error = 0.4f, .graph = 1},
                                 {.tier = Tier::kModal, .tick_us = kModal_us, .error = 0.15f},
                                 {.tier = Tier::kNetwork, .tick_us = kNetwork_us, .error = 0.08f}};
  frame::Front front;
  frame::make_front(points, publish_us, &front);
  return front;
}

// One level, of this cost.
inline frame::Front single_front(float tick_us) {
  const frame::Level points[] = {{.tier = Tier::kNetwork, .tick_us = tick_us, .error = 0.1f}};
  frame::Front front;
  frame::make_front(points, 0, &front);
  return front;
}

struct Crowd {
  std::vector<frame::Candidate> all;
  std::vector<frame::Overdue> overdue;
  std::vector<frame::Purchase> purchases;
  std::vector<uint32_t> open;
  std::vector<frame::Standing> standings;
  std::unique_ptr<frame::ScheduleScratch> scratch = std::make_unique<frame::ScheduleScratch>();

  Crowd(size_t count, const frame::Front& front)
      : all(count), overdue(count), purchases(count), open(count), standings(count) {
    for (size_t i = 0; i < count; ++i) {
      all[i].slot = static_cast<uint32_t>(i);
      all[i].front = &front;
      all[i].weight = 1;
      all[i].ticks = 1;
      all[i].top = front.best();
    }
  }
  frame::Candidate& operator[](size_t i) { return all[i]; }

  frame::ScheduleResult schedule(float budget_us) {
    scratch->overdue = overdue;
    scratch->purchases = purchases;
    scratch->open = open;
    scratch->standings = standings;
    return frame::schedule(all, budget_us, *scratch);
  }
  size_t count(uint32_t level) const {
    return static_cast<size_t>(std::ranges::count(all, level, &frame::Candidate::level));
  }
  size_t simulated() const { return all.size() - count(0); }
  double cost_us() const {
    double sum = 0;
    for (const frame::Candidate& c : all) sum += static_cast<double>(c.cost_us(c.level));
    return sum;
  }
  // Weight x error saved.
  double bought() const {
    double sum = 0;
    for (const frame::Candidate& c : all)
      sum += static_cast<double>(c.weight * (1 - c.front->levels[c.level].error));
    return sum;
  }
  // The world's bookkeeping between two steps.
  void age(float dt_s) {
    for (frame::Candidate& c : all) {
      c.held_s = c.level > c.has ? 0 : c.held_s + dt_s;
      c.waited_s = c.level > 0 ? 0 : c.waited_s + dt_s;
      c.turn_left_s = std::max(0.0f, c.turn_left_s - dt_s);
      c.has = c.level;
    }
  }
};

}  // namespace sinew::test
