// test_scheduler.cpp  What a budget buys: the most that is seen, little left over, no flicker, and a wait
// that is bounded.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "tests/frame/crowd.hpp"

using namespace sinew::frame;
using sinew::Tier;
using sinew::test::Crowd;
using sinew::test::kCoarse_us;
using sinew::test::kModal_us;
using sinew::test::kNetwork_us;
using sinew::test::single_front;
using sinew::test::usual_front;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity(),
                kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kDt_s = 1.0f / 60;
const Front kUsual = usual_front();

// The most that any choice of levels buys.
double optimum(const Crowd& crowd, double budget_us) {
  const auto best = [&](auto&& self, size_t i, double left) -> double {
    if (i == crowd.all.size()) return 0;
    const Candidate& c = crowd.all[i];
    double most = -1;
    for (uint32_t level = 0; level <= c.top; ++level) {
      const auto cost = static_cast<double>(c.cost_us(level));
      if (cost > left) continue;
      const double rest = self(self, i + 1, left - cost);
      if (rest >= 0)
        most = std::max(most, rest + static_cast<double>(c.weight * (1 - c.front->levels[level].error)));
    }
    return most;
  };
  return best(best, 0, budget_us);
}

// Levels are bought whole, so that a budget of a few of them leaves a rest that another choice may fill: the
// mean tells how good the rule is, the worst case how much a single level can matter among so few.
void check_near_the_optimum(std::vector<double> shares) {
  std::ranges::sort(shares);
  double mean = 0;
  for (const double share : shares) mean += share / static_cast<double>(shares.size());
  WARN("of the optimum over " << shares.size() << " cases: mean " << 100 * mean << " %, 5th percentile "
                              << 100 * shares[shares.size() / 20] << " %, worst " << 100 * shares.front()
                              << " %");
  CHECK(mean > 0.97);
  CHECK(shares[shares.size() / 20] > 0.9);
}

float unit(std::mt19937& random) { return std::uniform_real_distribution<float>(0, 1)(random); }

Front random_front(float scale_us, std::mt19937& random) {
  std::vector<Level> points;
  for (const Tier tier : {Tier::kModal, Tier::kNetwork, Tier::kModal, Tier::kNetwork})
    points.push_back({.tier = tier,
                      .tick_us = scale_us * (0.2f + 4 * unit(random)),
                      .error = 0.05f + 0.8f * unit(random)});
  Front front;
  make_front(points, scale_us * unit(random), &front);
  return front;
}

// Each level on another control graph than the one below it: coarse, fine, coarse, fine, or the other way.
Front to_and_fro_front(float scale_us, std::mt19937& random) {
  std::vector<Level> points;
  for (uint32_t i = 0; i < 5; ++i) {
    const float tick = 0.2f + static_cast<float>(i) + 0.5f * unit(random);
    points.push_back({.tier = Tier::kModal,
                      .tick_us = scale_us * tick,
                      .error = 0.05f + 0.8f * std::exp(-tick),
                      .graph = i % 2});
  }
  Front front;
  make_front(points, scale_us * unit(random), &front);
  return front;
}

// A candidate that has one of its levels already, for long enough not to be favoured.
void has_one_already(Candidate& c, std::mt19937& random) {
  c.has = static_cast<uint8_t>(1 + unit(random) * 0.999f * static_cast<float>(c.top));
  c.graph = static_cast<uint8_t>(c.front->levels[c.has].graph);
  c.change_us = 6 * c.front->levels[1].tick_us * unit(random);
  c.held_s = kHold_s;
}

enum class Begins { kDisplaced, kShownAsPosed, kOnOneOfItsGraphs };

// Random fronts, weights, costs, and a budget that pays for a part. Who is displaced pays for publishing in
// any case.
struct SmallCase {
  std::vector<Front> fronts;
  Crowd crowd;
  float budget_us = 0;

  SmallCase(int trial, Begins begins, std::mt19937& random)
      : fronts(two_fronts(begins, random)),
        crowd(3 + static_cast<size_t>(trial % (begins == Begins::kOnOneOfItsGraphs ? 3 : 5)), fronts[0]) {
    float all_us = 0;
    for (Candidate& c : crowd.all) {
      c.front = &fronts[c.slot % 2];
      c.top = c.front->best();
      c.weight = std::pow(10.0f, 2 * unit(random));
      if (begins != Begins::kShownAsPosed) c.base_us = c.front->publish_us * unit(random);
      if (begins == Begins::kOnOneOfItsGraphs) has_one_already(c, random);
      all_us += c.cost_us(c.top);
    }
    budget_us = all_us * (0.3f + 0.7f * unit(random));
  }
  double best() const { return optimum(crowd, static_cast<double>(budget_us)); }

 private:
  static std::vector<Front> two_fronts(Begins begins, std::mt19937& random) {
    std::vector<Front> out;
    for (int f = 0; f < 2; ++f) {
      const float scale_us = std::pow(10.0f, 2 * unit(random));
      out.push_back(begins == Begins::kOnOneOfItsGraphs ? to_and_fro_front(scale_us, random)
                                                        : random_front(scale_us, random));
    }
    return out;
  }
};

// Against every choice there is: what is bought, of the optimum.
std::vector<double> shares_of_the_optimum(Begins begins) {
  constexpr int kCases = 600;
  std::mt19937 random(11);
  std::vector<double> shares;
  for (int trial = 0; trial < kCases; ++trial) {
    SmallCase one(trial, begins, random);
    const double best = one.best();
    if (!(best > 0)) continue;
    one.crowd.schedule(one.budget_us);
    CHECK(one.crowd.cost_us() <= static_cast<double>(one.budget_us) * (1 + 1e-5));
    shares.push_back(one.crowd.bought() / best);
  }
  return shares;
}

// Weight x error saved a microsecond by the next level of each, or of the last: at most what the one before
// did.
struct NextLevel {
  uint32_t level, next;
  float key;
  bool open = true;

  explicit NextLevel(const Candidate& c) : level(0), next(c.next_level(0)), key(kInfinity) { look(c); }
  void look(const Candidate& c) {
    open = next <= c.top;
    if (!open) return;
    const float bonus = next > c.has ? 1 : c.held_s < kHold_s ? kHoldBonus : kHysteresis;
    key = std::min(key, c.weight / (c.ticks * c.cost_factor) * bonus * c.front->worth[next]);
  }
  void go_on(const Candidate& c) {
    level = next;
    next = c.next_level(level);
    look(c);
  }
};

std::vector<uint32_t> bought_one_by_one(const Crowd& crowd, double left) {
  std::vector<NextLevel> all(crowd.all.begin(), crowd.all.end());
  const auto best = [&] {
    size_t of = all.size();
    for (size_t i = 0; i < all.size(); ++i)
      if (all[i].open && (of == all.size() || all[i].key > all[of].key)) of = i;
    return of;
  };
  for (size_t i = best(); i < all.size(); i = best()) {
    const Candidate& c = crowd.all[i];
    const auto cost = static_cast<double>(std::max(0.0f, c.cost_us(all[i].next) - c.cost_us(all[i].level)));
    all[i].open = cost <= left;
    if (!all[i].open) continue;
    left -= cost;
    all[i].go_on(c);
  }
  std::vector<uint32_t> levels;
  for (const NextLevel& next : all) levels.push_back(next.level);
  return levels;
}

// What the next level would have saved, of the one of whom it would have saved most.
double most_passed_over(const Crowd& crowd) {
  double most = 0;
  for (const Candidate& c : crowd.all) {
    if (c.level == c.top) continue;
    const Level* has = &c.front->levels[c.level];
    most = std::max(most, static_cast<double>(c.weight * (has[0].error - has[1].error)));
  }
  return most;
}

// All that one may be: overdue, in its turn, with missed ticks, dearer bases than levels, tops below what it
// has.
void draw(Candidate& c, const Front& front, std::mt19937& random) {
  const uint32_t best = front.best();
  const auto some = [&](uint32_t most) {
    return static_cast<uint8_t>(unit(random) * (static_cast<float>(most) + 0.999f));
  };
  c.front = &front;
  c.top = unit(random) < 0.8f ? static_cast<uint8_t>(best) : some(best);
  c.weight = unit(random) < 0.1f ? 0 : std::pow(10.0f, 6 * unit(random) - 3);
  c.has = unit(random) < 0.3f ? uint8_t{0} : some(best);
  c.graph = unit(random) < 0.9f ? static_cast<uint8_t>(front.levels[c.has].graph) : some(1);
  c.waited_s = c.has == 0 && unit(random) < 0.5f ? 4 * unit(random) : 0;
  c.turn_left_s = c.has > 0 && unit(random) < 0.2f ? kHold_s * unit(random) : 0;
  c.held_s = unit(random);
  c.cost_factor = unit(random) < 0.5f ? 1 : 0.1f + 9.9f * unit(random) * unit(random);
  c.base_us = 8 * unit(random) * unit(random);
  c.enter_us = 20 * unit(random) * unit(random);
  c.change_us = 40 * unit(random);
  c.missed = unit(random) < 0.1f ? uint8_t{2} : uint8_t{0};
  c.keeps_level = unit(random) < 0.05f;
}

}  // namespace

TEST_CASE("importance_that_is_no_weight_is_mended") {
  CHECK(sane_importance(kNan) == 0);
  CHECK(sane_importance(-1) == 0);
  CHECK(std::isfinite(sane_importance(kInfinity)));
  CHECK(sane_importance(2.5f) == 2.5f);
}

TEST_CASE("missed_ticks_are_paid_for_in_the_place_of_what_enters") {
  const Level points[] = {{.tier = Tier::kModal, .tick_us = 2, .error = 0.5f, .graph = 2},
                          {.tier = Tier::kModal, .tick_us = 5, .error = 0.3f, .graph = 1},
                          {.tier = Tier::kNetwork, .tick_us = 20, .error = 0.1f, .graph = 0}};
  Front front;
  make_front(points, 1, &front);
  REQUIRE(front.count == 4);
  Candidate c{.front = &front, .ticks = 1, .enter_us = 100, .missed = 2, .top = 3};
  CHECK(c.cost_us(3) == Approx(1 + 3 * 20));
  CHECK(c.cost_us(2) == Approx(1 + 3 * 5));
  CHECK(c.cost_us(1) == Approx(1 + 3 * 2));
  c.graph = 1;
  CHECK(c.cost_us(2) == Approx(1 + 3 * 5));
  CHECK(c.cost_us(3) == Approx(1 + 3 * 20));  // a finer graph waits: at most that
  c.missed = 0;
  CHECK(c.cost_us(1) == Approx(1 + 2 + 100));
}

TEST_CASE("budgets_that_buy_nothing_leave_all_unsimulated") {
  for (const float budget_us : {0.0f, -5.0f, -kInfinity, kNan}) {
    Crowd crowd(4, kUsual);
    crowd[1].has = 3;
    CHECK(crowd.schedule(budget_us).denied);
    CHECK(crowd.simulated() == 0);
  }
}

TEST_CASE("nobody_is_scheduled_without_complaint") {
  Crowd nobody(0, kUsual);
  CHECK_FALSE(nobody.schedule(100).denied);
}

TEST_CASE("infinite_budget_is_the_best_for_all") {
  Crowd crowd(4, kUsual);
  crowd[2].weight = 0;
  crowd[3].cost_factor = 1e30f;
  CHECK_FALSE(crowd.schedule(kInfinity).denied);
  CHECK(crowd.count(3) == 4);
}

TEST_CASE("weights_beyond_numbers_are_survived") {
  Crowd crowd(3, kUsual);
  crowd[0].weight = std::numeric_limits<float>::max();
  crowd[0].waited_s = 1e9f;
  crowd[1].weight = 1e-20f;
  crowd[2].weight = 0;
  CHECK(crowd.schedule(2 * kNetwork_us).planned_us <= 2 * kNetwork_us);
  CHECK(crowd[0].level == 3);
  CHECK(crowd[1].level == 3);
}

// Networks for a few and nothing for the others would save less.
TEST_CASE("modes_for_all_come_before_networks_for_some") {
  Crowd crowd(10, kUsual);
  crowd.schedule(10 * kModal_us);
  CHECK(crowd.count(2) == 10);
  crowd.schedule(9 * kModal_us + kNetwork_us);
  CHECK(crowd.count(3) == 1);
  CHECK(crowd.count(2) == 9);
}

TEST_CASE("what_matters_more_gets_more") {
  Crowd crowd(3, kUsual);
  crowd[1].weight = 100;
  crowd.schedule(kNetwork_us + 2 * kCoarse_us);
  CHECK(crowd[1].level == 3);
  CHECK(crowd.count(1) == 2);
}

TEST_CASE("what_everyone_takes_anyway_comes_off_the_budget_first") {
  const Front front = single_front(10);
  Crowd crowd(5, front);
  for (Candidate& c : crowd.all) c.base_us = 3;
  crowd.schedule(15 + 2 * 7 + 1);
  CHECK(crowd.simulated() == 2);
}

TEST_CASE("an_instance_gets_no_more_than_it_may") {
  Crowd crowd(2, kUsual);
  crowd[0].top = 2;
  crowd[1].top = 0;
  CHECK_FALSE(crowd.schedule(1000).denied);
  CHECK(crowd[0].level == 2);
  CHECK(crowd[1].level == 0);
}

TEST_CASE("without_a_tick_the_level_stays_and_costs_nothing") {
  Crowd crowd(3, kUsual);
  crowd[0].keeps_level = crowd[1].keeps_level = true;
  crowd[0].has = 3;
  crowd.schedule(kNetwork_us);
  CHECK(crowd[0].level == 3);
  CHECK(crowd[1].level == 0);
  CHECK(crowd[2].level == 3);
}

TEST_CASE("weight_zero_gets_what_is_left_over") {
  Crowd crowd(2, kUsual);
  crowd[0].weight = 0;
  crowd.schedule(kNetwork_us);
  CHECK(crowd[0].level == 0);
  crowd.schedule(kNetwork_us + kModal_us);
  CHECK(crowd[0].level == 2);
}

TEST_CASE("answer_does_not_depend_on_the_order_of_the_question") {
  Crowd forward(40, kUsual);
  for (Candidate& c : forward.all) c.weight = static_cast<float>(c.slot % 3);
  Crowd backward = Crowd(40, kUsual);
  backward.all.assign(forward.all.rbegin(), forward.all.rend());
  forward.schedule(75);
  backward.schedule(75);
  for (size_t i = 0; i < 40; ++i) CHECK(forward[i].level == backward[39 - i].level);
}

TEST_CASE("within_a_few_per_cent_of_the_optimum_on_small_cases") {
  check_near_the_optimum(shares_of_the_optimum(Begins::kDisplaced));
}

TEST_CASE("within_a_few_per_cent_of_the_optimum_where_fronts_go_to_and_fro_between_graphs") {
  check_near_the_optimum(shares_of_the_optimum(Begins::kOnOneOfItsGraphs));
}

// Coarse, fine, coarse: what the change to the finer graph takes is more than the level above it does.
TEST_CASE("a_change_of_graphs_that_is_too_dear_is_no_bar_to_what_lies_above_it") {
  const Level points[] = {{.tier = Tier::kModal, .tick_us = 9, .error = 0.12f, .graph = 1},
                          {.tier = Tier::kModal, .tick_us = 21, .error = 0.103f},
                          {.tier = Tier::kNetwork, .tick_us = 31, .error = 0.09f, .graph = 1}};
  Front front;
  make_front(points, 0, &front);
  REQUIRE(front.count == 4);
  Crowd crowd(1, front);
  crowd[0].change_us = 80, crowd[0].graph = 1, crowd[0].has = 1;
  CHECK(crowd.schedule(60).planned_us == 31);
  CHECK(crowd[0].level == 3);
  CHECK(crowd.schedule(30).planned_us == 9);
  crowd[0].top = 2;
  CHECK(crowd.schedule(101).planned_us == 101);
  CHECK(crowd.schedule(60).planned_us == 9);
}

// Dantzig's bound. Until the first level that does not fit, the greedy pass is the optimum of the problem in
// which levels may be bought in part; with that level whole it is at least that optimum, and so at least
// every choice of whole levels. The worst case is therefore a budget that pays for one large level, or for
// small ones that save more a microsecond: those are bought, and the large one no longer fits.
TEST_CASE("what_a_budget_misses_is_less_than_the_best_level_that_was_passed_over") {
  constexpr int kCases = 1000;
  std::mt19937 random(23);
  double worst = 1;
  for (int trial = 0; trial < kCases; ++trial) {
    SmallCase one(trial, Begins::kShownAsPosed, random);
    const double best = one.best();
    if (!(best > 0)) continue;
    one.crowd.schedule(one.budget_us);
    const double bought = one.crowd.bought();
    CHECK(best <= (bought + most_passed_over(one.crowd)) * (1 + 1e-5));
    worst = std::min(worst, bought / best);
  }
  WARN("worst " << 100 * worst << " % of the optimum");
}

// The worst case in full: 51 us pay for two small levels, which save 3 in 5 us each, or for the large one,
// which saves 22.5 in 50. That one level is missed; were it to save more a microsecond, it would come first.
TEST_CASE("one_large_level_may_be_missed_for_small_ones_that_save_more_a_microsecond") {
  const Front small = single_front(5), large = single_front(50);
  Crowd crowd(3, small);
  for (Candidate& c : crowd.all) c.weight = 10 / 3.0f;
  crowd[2].front = &large;
  crowd[2].weight = 50 / 2.0f;
  crowd.schedule(51);
  CHECK(crowd.count(1) == 2);
  CHECK(crowd[2].level == 0);
  crowd[2].weight = 50;
  crowd.schedule(51);
  CHECK(crowd[2].level == 1);
  CHECK(crowd.count(1) == 1);
}

TEST_CASE("a_crowd_s_budget_is_spent_to_the_last_level_that_fits") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  double worst = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Crowd crowd(100, kUsual);
    for (Candidate& c : crowd.all)
      c.weight = std::pow(10.0f, 3 * unit(random)), c.cost_factor = 0.5f + unit(random);
    const float budget_us = 50 + 700 * unit(random);
    if (!crowd.schedule(budget_us).denied) continue;
    worst = std::max(worst, 1 - crowd.cost_us() / static_cast<double>(budget_us));
  }
  WARN("left unspent at most " << 100 * worst << " %");
  CHECK(worst < 0.03);
}

// Where the last step's budget ended is where the search begins.
TEST_CASE("answer_does_not_depend_on_the_budget_of_the_step_before") {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> unit(0, 1);
  Crowd crowd(80, kUsual);
  for (int step = 0; step < 300; ++step) {
    for (Candidate& c : crowd.all) c.weight = std::pow(10.0f, 4 * unit(random));
    const float budget_us = std::pow(10.0f, 3.2f * unit(random));
    Crowd fresh(80, kUsual);
    fresh.all = crowd.all;
    crowd.schedule(budget_us);
    fresh.schedule(budget_us);
    for (size_t i = 0; i < 80; ++i) CHECK(crowd[i].level == fresh[i].level);
  }
}

// However it is looked for: what is bought is what one bought who looks through all for the best that fits,
// again and again, while weights, budgets and what each has change.
TEST_CASE("levels_are_bought_as_if_the_best_that_fits_were_looked_for_among_all_each_time") {
  constexpr int kSteps = 400;
  std::mt19937 random(29);
  const Front fronts[] = {to_and_fro_front(3, random), random_front(5, random)};
  Crowd crowd(60, fronts[0]);
  for (Candidate& c : crowd.all) {
    c.front = &fronts[c.slot % 2];
    c.top = c.front->best();
    c.weight = std::pow(10.0f, 2 * unit(random));
    c.change_us = 6 * c.front->levels[1].tick_us * unit(random);
  }
  float budget_us = 200;
  size_t bought = 0;
  for (int step = 0; step < kSteps; ++step) {
    if (step % 20 == 0) budget_us = std::pow(10.0f, 1 + 2 * unit(random));
    for (Candidate& c : crowd.all) c.weight *= 0.9f + 0.2f * unit(random);
    crowd.schedule(budget_us);
    const std::vector<uint32_t> expected = bought_one_by_one(crowd, static_cast<double>(budget_us));
    for (size_t i = 0; i < expected.size(); ++i) CHECK(crowd[i].level == expected[i]);
    bought += crowd.simulated();
    crowd.age(kDt_s);
    for (Candidate& c : crowd.all) {
      c.waited_s = 0;  // turns are another matter
      if (c.has > 0) c.graph = static_cast<uint8_t>(c.front->levels[c.has].graph);
    }
  }
  CHECK(bought > 10 * kSteps);
}

// Lockstep rests on it: where the last search ended is in no snapshot.
TEST_CASE("answer_does_not_depend_on_where_it_is_looked_for_first") {
  std::mt19937 random(31);
  uint32_t turns = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Front fronts[] = {to_and_fro_front(3, random), random_front(1 + 30 * unit(random), random)};
    Crowd crowd(1 + static_cast<size_t>(60 * unit(random)), fronts[0]);
    float all_us = 0;
    for (Candidate& c : crowd.all) {
      draw(c, fronts[c.slot % 2], random);
      all_us += c.cost_us(c.top);
    }
    const std::vector<Candidate> asked = crowd.all;
    const float budget_us = all_us * unit(random);
    crowd.schedule(budget_us);
    const std::vector<Candidate> answered = crowd.all;
    const uint32_t ended = crowd.scratch->lowest, ends = WeightBuckets::fine_drawer_of(kInfinity);
    for (const uint32_t first : {0u, ends, ended, ended - std::min(ended, 40u), ended + 40, ended + 100}) {
      crowd.all = asked;
      crowd.scratch->lowest = std::min(first, ends);
      crowd.schedule(budget_us);
      bool same = true;
      for (size_t i = 0; i < asked.size(); ++i) {
        const Candidate &a = answered[i], &b = crowd[i];
        same &= a.level == b.level && a.turn_left_s == b.turn_left_s && a.reason == b.reason &&
                a.planned_us == b.planned_us;
        same &= b.planned_us == (b.keeps_level ? b.base_us : b.cost_us(b.level));
        turns += b.reason == Reason::kTurn;
      }
      REQUIRE(same);
    }
  }
  CHECK(turns > 1000);
}

TEST_CASE("what_one_has_is_not_taken_for_a_little_more") {
  const Front front = single_front(10);
  Crowd crowd(2, front);
  crowd.schedule(10);
  crowd.age(kDt_s);
  REQUIRE(crowd[0].has == 1);
  crowd[1].weight = 0.9f * kHoldBonus;
  crowd.schedule(10);
  CHECK(crowd[0].level == 1);
  CHECK(crowd[0].reason == Reason::kBest);
  crowd[1].weight = 1.1f * kHoldBonus;
  crowd.schedule(10);
  CHECK(crowd[1].level == 1);
  crowd[1].weight = 0.9f * kHysteresis;
  crowd[0].held_s = kHold_s;
  crowd.schedule(10);
  CHECK(crowd[0].level == 1);
  crowd[1].weight = 1.1f * kHysteresis;
  crowd.schedule(10);
  CHECK(crowd[1].level == 1);
}

TEST_CASE("weights_that_tremble_change_no_tiers") {
  Crowd crowd(60, kUsual);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> tremble(0.95f, 1.05f);
  std::vector<float> weights(60);
  for (float& w : weights) w = std::pow(10.0f, tremble(random) * 20 - 20);
  uint32_t changes = 0;
  for (int frame = 0; frame < 600; ++frame) {
    for (size_t i = 0; i < 60; ++i) crowd[i].weight = weights[i] * tremble(random);
    crowd.schedule(200);
    if (frame > 60)
      for (const Candidate& c : crowd.all) changes += c.level != c.has;
    crowd.age(kDt_s);
    for (Candidate& c : crowd.all) c.waited_s = 0;  // turns are another matter
  }
  WARN(changes << " changes in " << 540 * 60);
  CHECK(changes < 540 * 60 / 200);
}

// The bound that scheduler.hpp states, under weights that differ a millionfold.
TEST_CASE("longest_wait_is_bounded") {
  constexpr size_t kCount = 60, kTurns = 2;
  constexpr float kCost_us = 10;
  const Front front = single_front(kCost_us);
  Crowd crowd(kCount, front);
  for (Candidate& c : crowd.all) c.weight = std::pow(10.0f, static_cast<float>(c.slot % 7));
  const float bound_s = kLongestWait_s + std::ceil(static_cast<float>(kCount) / kTurns) * (kHold_s + kDt_s);
  float longest_s = 0;
  for (int frame = 0; frame < 60 * 60; ++frame) {
    crowd.schedule(kTurns * kCost_us / kTurnShare);
    crowd.age(kDt_s);
    for (const Candidate& c : crowd.all) longest_s = std::max(longest_s, c.waited_s);
  }
  WARN("longest wait " << longest_s << " s, bound " << bound_s << " s");
  CHECK(longest_s <= bound_s);
  CHECK(longest_s > kLongestWait_s);  // the scene does put the rule to the test
}

TEST_CASE("turns_of_a_large_crowd_leave_most_to_what_matters") {
  constexpr size_t kCount = 300;
  Crowd crowd(kCount, kUsual);
  crowd[7].weight = 1000;
  uint32_t best = 0;
  for (int frame = 0; frame < 60 * 30; ++frame) {
    crowd.schedule(20);
    best += crowd[7].level == 3;
    crowd.age(kDt_s);
  }
  CHECK(best == 60 * 30);
}

TEST_CASE("a_dear_one_is_not_starved_by_cheap_ones") {
  const Front dear = single_front(40), cheap = single_front(10);
  Crowd crowd(9, cheap);
  crowd[0].front = &dear;
  crowd[0].weight = 1e-3f;
  float longest_s = 0;
  for (int frame = 0; frame < 60 * 60; ++frame) {
    crowd.schedule(50);
    crowd.age(kDt_s);
    longest_s = std::max(longest_s, crowd[0].waited_s);
  }
  CHECK(longest_s <= kLongestWait_s + 9 * (kHold_s + kDt_s));
}

TEST_CASE("one_dearer_than_the_whole_budget_is_not_waited_for") {
  const Front dear = single_front(1000), cheap = single_front(10);
  Crowd crowd(3, cheap);
  crowd[0].front = &dear;
  crowd[0].waited_s = 100;
  crowd.schedule(20);
  CHECK(crowd[0].level == 0);
  CHECK(crowd.count(1) == 2);
}

// A level on a finer control graph takes more in the step that changes to it: once, and only on the way up.
TEST_CASE("a_finer_control_graph_is_paid_for_as_it_is_taken") {
  const Level points[] = {{.tier = Tier::kModal, .tick_us = 4, .error = 0.3f, .graph = 1},
                          {.tier = Tier::kModal, .tick_us = 6, .error = 0.2f},
                          {.tier = Tier::kNetwork, .tick_us = 10, .error = 0.1f}};
  Front front;
  make_front(points, 0, &front);
  Crowd crowd(1, front);
  crowd[0].change_us = 20, crowd[0].graph = 1;
  crowd.schedule(10);
  CHECK(crowd[0].level == 3);  // what is not simulated has no graph to change from
  crowd[0].has = 1;
  CHECK(crowd.schedule(25).planned_us == 4);
  CHECK(crowd.schedule(30).planned_us == 30);
  crowd[0].has = 2, crowd[0].graph = 0;
  CHECK(crowd.schedule(10).planned_us == 10);
  CHECK(crowd.schedule(5).planned_us == 4);
}

TEST_CASE("rises_add_up_to_what_a_level_takes_whatever_graphs_lie_between") {
  const Level points[] = {{.tier = Tier::kModal, .tick_us = 4, .error = 0.4f, .graph = 2},
                          {.tier = Tier::kModal, .tick_us = 6, .error = 0.3f},
                          {.tier = Tier::kModal, .tick_us = 40, .error = 0.2f, .graph = 1},
                          {.tier = Tier::kNetwork, .tick_us = 80, .error = 0.1f}};
  Front front;
  make_front(points, 0, &front);
  for (uint8_t has = 0; has <= 4; ++has) {
    Candidate c = {.front = &front, .ticks = 1, .base_us = 1, .enter_us = 7, .change_us = 20, .has = has};
    if (has > 0) c.graph = static_cast<uint8_t>(front.levels[has].graph);
    c.top = 4;
    float sum_us = c.base_us;
    for (uint32_t below = 0, level = c.next_level(0); level <= 4;
         below = level, level = c.next_level(level)) {
      sum_us += c.cost_us(level) - c.cost_us(below);
      INFO("has " << has << ", level " << level);
      CHECK(sum_us == Approx(c.cost_us(level)));
    }
  }
}

// The yardstick sorts as many keys as there are levels to buy, in the same process: a schedule that sorted
// them all would take longer. The quickest of three hundred, of both, is little moved by what else runs.
TEST_CASE("half_a_thousand_are_scheduled_sooner_than_their_levels_could_be_sorted") {
  using Clock = std::chrono::steady_clock;
  Crowd crowd(500, kUsual);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> unit(0, 1);
  for (Candidate& c : crowd.all) c.weight = std::pow(10.0f, 2 * unit(random));
  std::vector<double> schedule_us, sort_us;
  const auto time_us = [](const auto& work) {
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  };
  for (int frame = 0; frame < 300; ++frame) {
    std::vector<Purchase> levels;
    for (Candidate& c : crowd.all) {
      c.weight *= 0.99f + 0.02f * unit(random);
      for (uint32_t level = 1; level <= c.top; ++level)
        levels.push_back({c.weight * c.front->worth[level], c.slot, level, 0});
    }
    schedule_us.push_back(time_us([&] { crowd.schedule(1500); }));
    sort_us.push_back(time_us([&] { std::ranges::sort(levels, std::greater(), &Purchase::key); }));
    crowd.age(kDt_s);
  }
  std::ranges::sort(schedule_us);
  std::ranges::sort(sort_us);
  WARN("500: scheduled in " << schedule_us[0] << " us, median " << schedule_us[150] << ", p95 "
                            << schedule_us[285] << "; their 1,500 levels sorted in " << sort_us[0]
                            << ", median " << sort_us[150]);
  CHECK(schedule_us[0] < sort_us[0]);
}
