// stopwatch.hpp  Clocks, medians, and things timed in turn, so that a busy neighbour hurts all alike.
#pragma once
#include <time.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

namespace sinew::perf {

inline double clock_us(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

// Interrupts that are due come as a system call returns, such as the one that reads a thread's clock: now,
// and not within what is timed next.
inline void let_interrupts_by() {
  const double until_us = clock_us(CLOCK_THREAD_CPUTIME_ID) + 5;
  while (clock_us(CLOCK_THREAD_CPUTIME_ID) < until_us) {
  }
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

inline double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Something to time: `work` runs `repeats` times between two looks at the clocks.
struct Lap {
  std::string name;
  int repeats;
  std::function<void()> work;
  std::vector<double> cpu_us = {}, wall_us = {};  // one run's share, a round each; cpu of all threads
};

inline void run_lap(Lap& lap) {
  const double cpu = clock_us(CLOCK_PROCESS_CPUTIME_ID), wall = clock_us(CLOCK_MONOTONIC);
  for (int i = 0; i < lap.repeats; ++i) lap.work();
  lap.wall_us.push_back((clock_us(CLOCK_MONOTONIC) - wall) / lap.repeats);
  lap.cpu_us.push_back((clock_us(CLOCK_PROCESS_CPUTIME_ID) - cpu) / lap.repeats);
}

// All laps once a round; the first round is not counted.
inline void run_laps(std::vector<Lap>& laps, int rounds) {
  for (int round = 0; round <= rounds; ++round) {
    for (Lap& lap : laps) {
      run_lap(lap);
      if (round == 0) lap.cpu_us.clear(), lap.wall_us.clear();
    }
  }
}

inline const Lap& lap_named(const std::vector<Lap>& laps, const std::string& name) {
  return *std::ranges::find(laps, name, &Lap::name);
}

}  // namespace sinew::perf
