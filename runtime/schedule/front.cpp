// front.cpp  see front.hpp.
#include "schedule/front.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::frame {
namespace {

bool counts(const Level& point) noexcept {
  return is_simulated(point.tier) && point.tick_us >= 0 && std::isfinite(point.tick_us) && point.error >= 0 &&
         point.error < 1;
}

float cost_between(const Front& front, const Level& from, const Level& to) noexcept {
  constexpr float kLeast_us = 1e-6f;
  const float entry_us = is_simulated(from.tier) ? 0 : front.publish_us;
  return std::max(kLeast_us, to.tick_us - from.tick_us + entry_us);
}

float worth_between(const Front& front, const Level& from, const Level& to) noexcept {
  return (from.error - to.error) / cost_between(front, from, to);
}

// What is not on the front counts as the lowest that is simulated.
void list_levels(Front& front) noexcept {
  for (size_t tier = 0; tier < kTierCount; ++tier) {
    const uint8_t lowest = is_simulated(static_cast<Tier>(tier)) && front.count > 1 ? 1 : 0;
    std::fill_n(front.level_at[tier], pack::kMostGraphLevels, lowest);
  }
  for (uint32_t i = 1; i < front.count; ++i)
    front.level_at[static_cast<size_t>(front.levels[i].tier)][front.levels[i].graph] =
        static_cast<uint8_t>(i);
}

// The last level is no better bought than what comes behind it.
bool is_passed_over(const Front& front, const Level& next) noexcept {
  if (front.count < 2) return false;
  const Level &below = front.levels[front.count - 2], &last = front.levels[front.count - 1];
  return worth_between(front, below, next) >= worth_between(front, below, last);
}

uint32_t coarser_above(const Front& front, uint32_t level) noexcept {
  for (uint32_t above = level + 1; above < front.count; ++above)
    if (front.levels[above].graph > front.levels[level].graph) return above;
  return 0;
}

}  // namespace

float usual_error(Tier tier) noexcept {
  constexpr float kNetwork = 0.08f, kModal = 0.15f;
  if (tier == Tier::kNetwork) return kNetwork;
  return tier == Tier::kModal ? kModal : 1;
}

float coarser_error(float finest, uint32_t graph) noexcept {
  constexpr float kCoarser = 1.15f;
  for (uint32_t level = 0; level < graph; ++level) finest *= kCoarser;
  return finest;
}

void make_front(std::span<const Level> points, float publish_us, Front* out) noexcept {
  Level sorted[kMostLevels];
  uint32_t count = 0;
  for (const Level& point : points)
    if (counts(point) && count < kMostLevels - 1) sorted[count++] = point;
  std::sort(sorted, sorted + count, [](const Level& a, const Level& b) {
    return a.tick_us != b.tick_us ? a.tick_us < b.tick_us : a.error < b.error;
  });
  out->publish_us = publish_us;
  out->count = 1;
  out->levels[0] = {};
  for (uint32_t i = 0; i < count; ++i) {
    if (sorted[i].error >= out->levels[out->count - 1].error) continue;
    while (is_passed_over(*out, sorted[i])) --out->count;
    out->levels[out->count++] = sorted[i];
  }
  for (uint32_t level = 1; level < out->count; ++level) {
    out->worth[level] = worth_between(*out, out->levels[level - 1], out->levels[level]);
    out->coarser[level] = coarser_above(*out, level);
  }
  list_levels(*out);
}

}  // namespace sinew::frame
