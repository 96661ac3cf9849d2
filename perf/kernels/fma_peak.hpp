// fma_peak.hpp  The yardstick: how many float operations a second this core does when nothing but fused
// multiply-adds run.
#pragma once
#include <cstdint>

namespace sinew::perf {

// Runs `rounds` rounds of independent multiply-adds on the best instruction set; returns the floating-point
// operations done (two a multiply-add and lane). *sink keeps the compiler from leaving them out.
uint64_t run_fma(uint64_t rounds, float* sink);

// GFLOP/s: the best of several short runs in this process, thread CPU time.
double fma_peak_gflops();

}  // namespace sinew::perf
