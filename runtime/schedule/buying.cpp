// buying.cpp  see buying.hpp.
#include "schedule/buying.hpp"

#include <algorithm>
#include <limits>

#include "schedule/turns.hpp"

namespace sinew::frame {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr uint32_t kNarrow = 32, kWide = 128;  // fine drawers: a quarter of an octave, a whole one

// In whole 2^-20 us: below 2^32 us sums and differences are exact.
double exact(float us) noexcept {
  constexpr double kShift = 0x1.8p32;
  return (static_cast<double>(us) + kShift) - kShift;
}

double whole_us(const Candidate& c, uint32_t level) noexcept { return exact(c.cost_us(level)); }

// Weight x error saved a microsecond.
float key_of(const Candidate& c, uint32_t level) noexcept {
  return c.rate * (level > c.has ? 1 : c.bonus()) * c.front->worth[level];
}

uint8_t begins_at(const Candidate& c) noexcept { return c.reason == Reason::kTurn ? 1 : 0; }

// Of a level above the one it has been given: its steps one by one, each as good as the one before at most,
// while they cost no more than `most`. Work(level, key, cost) says whether to go on.
template <class Work>
void for_each_step_up(const Candidate& c, double most, Work work) noexcept {
  float key = std::numeric_limits<float>::max();
  double below_us = whole_us(c, c.level);
  for (uint32_t level = c.next_level(c.level); level <= c.top; level = c.next_level(level)) {
    const double level_us = whole_us(c, level), cost = std::max(0.0, level_us - below_us);
    if (!(cost <= most)) return;
    key = std::min(key, key_of(c, level));
    if (!work(level, key, cost)) return;
    below_us = level_us;
  }
}

struct Dearer {
  std::span<const Candidate> all;
  bool operator()(const Purchase& a, const Purchase& b) const noexcept {
    if (a.key != b.key) return a.key < b.key;
    const uint32_t x = all[a.candidate].slot, y = all[b.candidate].slot;
    return x != y ? x > y : a.level > b.level;
  }
};

// The next of the same candidate, as good as this one at most. False: there is none.
bool next_of(const Candidate& c, Purchase& purchase) noexcept {
  const uint32_t level = c.next_level(purchase.level);
  if (level > c.top) return false;
  purchase.key = std::min(purchase.key, key_of(c, level));
  purchase.cost_us = std::max(0.0, whole_us(c, level) - whole_us(c, purchase.level));
  purchase.level = level;
  return true;
}

// In the order of Dearer, without what is not to be had for `left`.
std::span<Purchase> heap_within(std::span<Purchase> purchases, double left, const Dearer& dearer) noexcept {
  const auto end = std::remove_if(purchases.begin(), purchases.end(),
                                  [&](const Purchase& p) { return !(p.cost_us <= left); });
  std::make_heap(purchases.begin(), end, dearer);
  return {purchases.begin(), end};
}

void take(Candidate& c, uint32_t level) noexcept {
  c.level = static_cast<uint8_t>(level);
  c.planned_us = c.cost_us(level);
}

// What has no weight comes behind all that has.
void weigh(Candidate& c) noexcept {
  constexpr float kLeast = 1e-30f, kFewest = 1e-3f;
  const float staleness = 1 + c.waited_s / kStaleness_s;
  c.rate = std::max(kLeast, c.weight * staleness) / std::max(kFewest, c.ticks * c.cost_factor);
  c.may_refine = (c.has > 0) & (c.graph > 0);
}

// Of one that is bought what it has, and no more. Who has what is hard to foretell: hardly a branch depends
// on it.
Standing standing_of(const Candidate& c) noexcept {
  if (c.missed > 0) return {.has_key = -kInfinity};  // levels may be passed over
  static constexpr float kBonus[2] = {kHysteresis, kHoldBonus};
  constexpr float kRoundedDown = 1 - 0x1p-21f;
  const uint32_t at = std::min(c.has, c.top), has_one = at > 0, next = std::min<uint32_t>(at + 1, c.top);
  const Front& front = *c.front;
  const float ticks = c.ticks * c.cost_factor;
  const float has_us = front.step_us(at, ticks);
  Standing s{.takes_us = has_one * (exact(has_us) - exact(c.base_us))};
  const float keys[2] = {kInfinity, c.rate * kBonus[c.held_s < kHold_s] * front.worth[at]};
  s.has_key = keys[has_one];
  if (front.step_us(1, ticks) < c.base_us) s.has_key = -kInfinity;
  const float enters_us[2] = {0, c.enter_us};
  const float now_us[2] = {c.base_us, has_us};
  const float more_us = kRoundedDown * (front.step_us(next, ticks) + enters_us[c.has == 0]) - now_us[has_one];
  const float next_keys[2] = {s.next_key, c.rate * front.worth[next]};
  const float nexts_us[2] = {s.next_us, more_us};
  s.next_key = next_keys[next > at];
  s.next_us = nexts_us[next > at];
  return s;
}

}  // namespace

Buying::Buying(std::span<Candidate> candidates, ScheduleScratch& scratch) noexcept
    : candidates_(candidates), scratch_(scratch), window_(window_about(scratch.lowest, kNarrow)) {}

Buying::Window Buying::window_about(uint32_t drawer, uint32_t width) noexcept {
  constexpr uint32_t kMost = WeightBuckets::fine_drawer_of(kInfinity) - kWide;
  const uint32_t first = std::min(drawer - std::min(drawer, width / 2), kMost), end = first + width;
  return {first, end, WeightBuckets::begin_of(first), WeightBuckets::begin_of(end)};
}

void Buying::open(uint32_t candidate) noexcept {
  Candidate& c = candidates_[candidate];
  c.level = begins_at(c);
  scratch_.open[open_++] = candidate;
}

// Among those that stay or those that may go up or down.
void Buying::place(uint32_t candidate, double most) noexcept {
  Standing& s = scratch_.standings[candidate];
  if (s.takes_us > most) s.has_key = -kInfinity;
  if (window_.moves(s)) return open(candidate);
  closed_us_ += s.takes_us;
  wants_more_ |= s.next_key >= 0;
}

Asked Buying::ask_all() noexcept {
  Asked asked;
  for (uint32_t i = 0; i < candidates_.size(); ++i) {
    Candidate& c = candidates_[i];
    weigh(c);
    c.reason = Reason::kBudget;
    c.level = c.keeps_level ? c.has : std::min(c.has, c.top);
    c.planned_us = c.base_us;
    asked.base_us += static_cast<double>(c.base_us);
    scratch_.standings[i] = {};
    if (!chooses(c)) continue;
    scratch_.standings[i] = standing_of(c);
    const float planned_us[2] = {c.base_us, c.front->step_us(c.level, c.ticks * c.cost_factor)};
    c.planned_us = planned_us[c.level > 0];
    if (is_overdue(c)) scratch_.overdue[asked.overdue++] = {order_of(c), i};
    place(i, std::numeric_limits<double>::infinity());
  }
  return asked;
}

void Buying::give_turn(uint32_t candidate) noexcept {
  Candidate& c = candidates_[candidate];
  Standing& s = scratch_.standings[candidate];
  const bool stayed = !window_.moves(s);
  if (stayed) closed_us_ -= s.takes_us;
  s.has_key = -kInfinity;
  c.reason = Reason::kTurn;
  c.level = 1;
  if (stayed) open(candidate);
}

void Buying::buy_nothing() noexcept {
  for (Candidate& c : candidates_)
    if (chooses(c)) take(c, 0);
}

void Buying::buy_all() noexcept {
  for (Candidate& c : candidates_)
    if (chooses(c)) take(c, c.top);
}

void Buying::search_about(uint32_t drawer, uint32_t width, double left) noexcept {
  window_ = window_about(drawer, width);
  closed_us_ = 0, open_ = 0, wants_more_ = false;
  for (uint32_t i = 0; i < candidates_.size(); ++i) {
    Candidate& c = candidates_[i];
    if (!chooses(c)) continue;
    c.level = std::min(c.has, c.top);
    place(i, left);
  }
}

// Sixteenths of an octave over all levels of all.
uint32_t Buying::coarse_lowest(double left) noexcept {
  scratch_.buckets.clear();
  for (Candidate& c : candidates_) {
    if (!chooses(c)) continue;
    c.level = begins_at(c);
    for_each_step_up(c, left, [&](uint32_t, float key, double cost) {
      scratch_.buckets.add(WeightBuckets::drawer_of(key), cost);
      return true;
    });
  }
  return scratch_.buckets.lowest_within(left);
}

// False: it lies outside of the window.
bool Buying::find_lowest(double left) noexcept {
  double sums[kWide] = {}, sum = closed_us_;
  for (const uint32_t i : scratch_.open.first(open_)) {
    for_each_step_up(candidates_[i], left, [&](uint32_t, float key, double cost) {
      const uint32_t drawer = WeightBuckets::fine_drawer_of(key);
      if (drawer < window_.first) return wants_more_ = true, false;
      (drawer < window_.end ? sums[drawer - window_.first] : sum) += cost;
      return true;
    });
  }
  lowest_ = window_.end;
  rest_us_ = left - sum;
  if (sum > left) return false;
  for (; lowest_ > window_.first && sum + sums[lowest_ - 1 - window_.first] <= left; --lowest_)
    sum += sums[lowest_ - 1 - window_.first];
  rest_us_ = left - sum;
  return lowest_ > window_.first || !wants_more_;
}

// Takes what lies in the drawers from the lowest on; gathers the next step of each, where the rest pays for
// it.
uint32_t Buying::take_open(double left) noexcept {
  uint32_t count = 0;
  for (const uint32_t i : scratch_.open.first(open_)) {
    uint32_t reached = candidates_[i].level;
    for_each_step_up(candidates_[i], left, [&](uint32_t level, float key, double cost) {
      if (WeightBuckets::fine_drawer_of(key) >= lowest_) return reached = level, true;
      if (cost <= rest_us_) scratch_.purchases[count++] = {key, i, level, cost};
      return false;
    });
    take(candidates_[i], reached);
  }
  return count;
}

// Behind `count` purchases those of who stays.
uint32_t Buying::gather_next(uint32_t count) noexcept {
  constexpr double kRounding = 1e-5;
  const auto most = static_cast<float>(rest_us_ * (1 + kRounding) + kRounding);
  for (uint32_t i = 0; i < candidates_.size(); ++i) {
    const Standing& s = scratch_.standings[i];
    if (!(s.next_us <= most) || window_.moves(s)) continue;
    Purchase next{std::numeric_limits<float>::max(), i, candidates_[i].level, 0};
    if (next_of(candidates_[i], next) && next.cost_us <= rest_us_) scratch_.purchases[count++] = next;
  }
  return count;
}

// By the keys themselves, down to this one. Returns how many purchases are left that the rest pays for.
uint32_t Buying::spend_rest(uint32_t count, float least_key) noexcept {
  constexpr size_t kSorted = 16;  // as many are sorted again for each that is found to be too dear
  const Dearer dearer{candidates_};
  std::span<Purchase> heap = heap_within(scratch_.purchases.first(count), rest_us_, dearer);
  for (size_t too_dear = 0; !heap.empty() && heap.front().key >= least_key;) {
    std::pop_heap(heap.begin(), heap.end(), dearer);
    Purchase& best = heap.back();
    Candidate& c = candidates_[best.candidate];
    const bool fits = best.cost_us <= rest_us_;
    if (fits) rest_us_ -= best.cost_us, take(c, best.level);
    if (fits && next_of(c, best)) {
      std::push_heap(heap.begin(), heap.end(), dearer);
      continue;
    }
    heap = heap.first(heap.size() - 1);
    too_dear += !fits;
    if (too_dear * kSorted > heap.size()) heap = heap_within(heap, rest_us_, dearer), too_dear = 0;
  }
  return static_cast<uint32_t>(heap.size());
}

void Buying::buy(double left) noexcept {
  bool found = find_lowest(left);
  if (!found) {
    search_about(scratch_.lowest, kWide, left);
    found = find_lowest(left);
  }
  if (!found) {
    search_about(coarse_lowest(left) * WeightBuckets::kFineInADrawer, kNarrow, left);
    find_lowest(left);
  }
  if (wants_more_) scratch_.lowest = lowest_;
  // What may go up within the window comes before what stays.
  const uint32_t passed_over = spend_rest(take_open(left), window_.least);
  spend_rest(gather_next(passed_over), 0);
}

}  // namespace sinew::frame
