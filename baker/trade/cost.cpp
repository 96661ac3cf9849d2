// cost.cpp  see cost.hpp.
#include "baker/trade/cost.hpp"

#include <unistd.h>

#include <algorithm>

#include "baker/measure/yardstick.hpp"
#include "character/life/create_instance.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kWarmUpTicks = 24;
constexpr int kWarmPasses = 7;
constexpr size_t kColdSteps = 2400;  // of all instances together

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

Cost cost_of(std::vector<double> steps_us) {
  return {.p50_us = quantile(steps_us, 0.5), .p99_us = quantile(steps_us, 0.99)};
}

double last_step_us(const ClosedLoop& loop) { return static_cast<double>(loop.step_ns()) * 1e-3; }

// True where the step counts.
bool step(ClosedLoop& loop, size_t tick, Tier tier, uint32_t level) {
  const bool begins = tier == Tier::kExtrapolate && tick % (kCarriedTicks + 1) == 0;
  if (begins)
    loop.tick();
  else
    loop.tick(tier, level);
  return !begins;
}

size_t crowd_of(const LoadedPack& character, const TrueMotion& motion) {
  constexpr size_t kUsualBytes = 32u << 20, kMost = 2000;
  const long stated = sysconf(_SC_LEVEL3_CACHE_SIZE);
  const size_t cache = stated > 0 ? static_cast<size_t>(stated) : kUsualBytes;
  const ClosedLoop one(character, motion);
  return std::min(kMost, 1 + 3 * cache / 2 / world::instance_bytes(*one.instance().asset));
}

}  // namespace

namespace {

Cost along(const LoadedPack& character, const TrueMotion& motion, Tier tier, uint32_t level) {
  ClosedLoop loop(character, motion);
  std::vector<double> steps_us;
  const size_t last = std::min(motion.ticks(), kMostTicks);
  for (size_t tick = 1; tick <= last; ++tick) {
    const bool counts = step(loop, tick - 1, tier, level);
    if (counts && tick > std::min(kWarmUpTicks, last / 2)) steps_us.push_back(last_step_us(loop));
  }
  return cost_of(std::move(steps_us));
}

}  // namespace

Cost warm_cost(const LoadedPack& character, const TrueMotion& motion, Tier tier, uint32_t level) {
  Cost best = along(character, motion, tier, level);
  for (int pass = 1; pass < kWarmPasses; ++pass) {
    const Cost cost = along(character, motion, tier, level);
    if (cost.p50_us < best.p50_us) best = cost;
  }
  return best;
}

Crowd::Crowd(const LoadedPack& character, const TrueMotion& motion) {
  const size_t count = crowd_of(character, motion);
  for (size_t i = 0; i < count; ++i) loops_.push_back(std::make_unique<ClosedLoop>(character, motion));
  loops_.front()->save(&start_);
  rounds_ = std::min(motion.ticks(), kWarmUpTicks / 2 + std::max<size_t>(12, kColdSteps / count));
}

Cost Crowd::cold_cost(Tier tier, uint32_t level) {
  for (const auto& loop : loops_) loop->restore(start_);
  std::vector<double> steps_us;
  for (size_t tick = 1; tick <= rounds_; ++tick) {
    for (const auto& loop : loops_) {
      const bool counts = step(*loop, tick - 1, tier, level);
      if (counts && tick > std::min(kWarmUpTicks / 2, rounds_ / 2)) steps_us.push_back(last_step_us(*loop));
    }
  }
  return cost_of(std::move(steps_us));
}

}  // namespace sinew::baker
