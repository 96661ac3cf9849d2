// workers.cpp  One large network on one and on two workers, beside what two workers can do at all.
#include "core/run_tasks.hpp"
#include "perf/kernels/bench_data.hpp"
#include "perf/kernels/fma_peak.hpp"
#include "perf/scale/groups.hpp"
#include "perf/scale/record.hpp"
#include "perf/scale/stopwatch.hpp"
#include "samples/demo/thread_pool.hpp"

namespace sinew::perf {
namespace {

// The peak's loop, twice: one after the other, or side by side.
void run_peak(void*, uint32_t) {
  float sink = 0;
  run_fma(1'000'000, &sink);
  benchmark::DoNotOptimize(sink);
}

}  // namespace

void measure_workers(int rounds) {
  demo::ThreadPool pool(2);
  std::vector<Lap> laps = {
      {"peak 1", 1, [&] { core::run_tasks({}, run_peak, nullptr, 2); }},
      {"peak 2", 1, [&] { core::run_tasks(pool.hook(), run_peak, nullptr, 2); }},
  };
  run_laps(laps, rounds);
  const auto us = [&](const char* name) { return median(lap_named(laps, name).wall_us); };
  put({.group = "workers", .subject = "fma_peak twice", .workers = 2}, "one_over_two",
      us("peak 1") / us("peak 2"));
}

}  // namespace sinew::perf
