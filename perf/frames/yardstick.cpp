// yardstick.cpp  see yardstick.hpp.
#include "perf/frames/yardstick.hpp"

#include "perf/kernels/fma_peak.hpp"
#include "perf/scale/stopwatch.hpp"

namespace sinew::perf {
namespace {

FrameCost timed(uint64_t rounds) {
  static float sink = 0;
  let_interrupts_by();
  const double cpu = clock_us(CLOCK_THREAD_CPUTIME_ID), wall = clock_us(CLOCK_MONOTONIC);
  run_fma(rounds, &sink);
  FrameCost cost;
  cost.wall_us = static_cast<float>(clock_us(CLOCK_MONOTONIC) - wall);
  cost.cpu_us = static_cast<float>(clock_us(CLOCK_THREAD_CPUTIME_ID) - cpu);
  return cost;
}

uint64_t rounds_of(double us) {
  constexpr uint64_t kTried = 10'000;
  std::vector<double> taken_us;
  for (int i = 0; i < 200; ++i) taken_us.push_back(static_cast<double>(timed(kTried).cpu_us));
  return static_cast<uint64_t>(us / median(taken_us) * kTried);
}

}  // namespace

std::vector<FrameCost> run_yardstick(float budget_us, uint32_t frames) {
  const uint64_t rounds = rounds_of(0.9 * static_cast<double>(budget_us));
  std::vector<FrameCost> costs;
  costs.reserve(frames);
  for (uint32_t f = 0; f < frames; ++f) costs.push_back(timed(rounds));
  return costs;
}

}  // namespace sinew::perf
