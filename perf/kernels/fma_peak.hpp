// fma_peak.hpp  The yardstick of float32: nothing but independent fused multiply-adds.
#pragma once
#include <cstdint>

namespace sinew::perf {

// `rounds` of twelve vectors' multiply-adds, of the best instruction set of this processor. Returns the
// operations done, a multiply-add counted as two; *sink keeps them from being optimised away.
double run_fma(uint64_t rounds, float* sink);

}  // namespace sinew::perf
