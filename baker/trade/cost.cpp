// cost.cpp  see cost.hpp.
#include "baker/trade/cost.hpp"

#include <unistd.h>

#include <algorithm>

#include "baker/programs/yardstick.hpp"

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

class Steps {
 public:
  void add(const ClosedLoop& loop) {
    const bool simulated = loop.instance().heard_now;
    (simulated ? simulated_ : between_).push_back(static_cast<double>(loop.step_ns()) * 1e-3);
  }
  Cost cost() {
    std::vector<double>& told = simulated_.empty() ? between_ : simulated_;
    const double many = static_cast<double>(simulated_.size()), few = static_cast<double>(between_.size());
    return {.p50_us = quantile(told, 0.5),
            .p99_us = quantile(told, 0.99),
            .mean_us = (many * quantile(simulated_, 0.5) + few * quantile(between_, 0.5)) / (many + few)};
  }

 private:
  std::vector<double> simulated_, between_;
};

// True where the step counts.
bool step(ClosedLoop& loop, size_t tick, Tier tier, uint32_t every, uint32_t level) {
  const bool begins = tier == Tier::kExtrapolate && tick % (kCarriedTicks + 1) == 0;
  if (begins)
    loop.tick();
  else
    loop.tick(tier, every, level);
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

Cost along(const LoadedPack& character, const TrueMotion& motion, Tier tier, uint32_t every, uint32_t level) {
  ClosedLoop loop(character, motion);
  Steps steps;
  const size_t last = std::min(motion.ticks(), kMostTicks);
  for (size_t tick = 1; tick <= last; ++tick) {
    const bool counts = step(loop, tick - 1, tier, every, level);
    if (counts && tick > std::min(kWarmUpTicks, last / 2)) steps.add(loop);
  }
  return steps.cost();
}

}  // namespace

Cost warm_cost(const LoadedPack& character, const TrueMotion& motion, Tier tier, uint32_t every,
               uint32_t level) {
  Cost best = along(character, motion, tier, every, level);
  for (int pass = 1; pass < kWarmPasses; ++pass) {
    const Cost cost = along(character, motion, tier, every, level);
    if (cost.mean_us < best.mean_us) best = cost;
  }
  return best;
}

Crowd::Crowd(const LoadedPack& character, const TrueMotion& motion) {
  const size_t count = crowd_of(character, motion);
  for (size_t i = 0; i < count; ++i) loops_.push_back(std::make_unique<ClosedLoop>(character, motion));
  loops_.front()->save(&start_);
  rounds_ = std::min(motion.ticks(), kWarmUpTicks / 2 + std::max<size_t>(12, kColdSteps / count));
}

Cost Crowd::cold_cost(Tier tier, uint32_t every, uint32_t level) {
  for (const auto& loop : loops_) loop->restore(start_);
  Steps steps;
  for (size_t tick = 1; tick <= rounds_; ++tick) {
    for (const auto& loop : loops_) {
      const bool counts = step(*loop, tick - 1, tier, every, level);
      if (counts && tick > std::min(kWarmUpTicks / 2, rounds_ / 2)) steps.add(*loop);
    }
  }
  return steps.cost();
}

}  // namespace sinew::baker
