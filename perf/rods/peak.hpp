// peak.hpp  The processor's multiply-add peak, for comparing machines.
#pragma once
#include "perf/kernels/fma_peak.hpp"
#include "perf/scale/stopwatch.hpp"

namespace sinew::perf {

// Median of fifteen runs, by the thread's own time.
inline double peak_gflops() {
  float sink = 1;
  std::vector<double> measured;
  for (int i = 0; i < 15; ++i) {
    const double begin = clock_us(CLOCK_THREAD_CPUTIME_ID);
    const double operations = run_fma(1'000'000, &sink);
    measured.push_back(1e-3 * operations / (clock_us(CLOCK_THREAD_CPUTIME_ID) - begin));
  }
  return median(measured);
}

}  // namespace sinew::perf
