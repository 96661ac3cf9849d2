// measure.hpp  How long a step takes until it is this exact.
#pragma once
#include "perf/trade/cases.hpp"

namespace sinew::perf {

// Largest residual of a step that counts as solved (RodReport::residual), with contacts' forces, gaps and
// slips where rods touch.
inline constexpr double kResiduals[] = {1e-2, 1e-4, 1e-6};

// Over states of the scene that all solvers and starts are tried from.
struct Reached {
  double residual;
  uint32_t states, reached;
  double iterations_mean, inner_mean;  // of the states where it was reached
  uint32_t iterations_most;
  double strand_us;  // median of the step's thread CPU time over its strands, not reached counted as never
  double error;      // median distance from the step's exact end, in segment lengths, where it was reached
};

// The scene goes on by tight direct steps; from every tenth of its states the case's step is taken with 1, 2,
// ... iterations until its residual is small enough, then as often again for the time, without asking for the
// residual. The same states for every solver
// and start, but for rounding; contact forces are part of a state. Throws std::runtime_error where a batch is
// refused.
std::vector<Reached> measure(const TradeCase& c);

}  // namespace sinew::perf
