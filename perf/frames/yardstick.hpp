// yardstick.hpp  What the machine does to work that is always the same: nothing but multiply-adds, about as
// long as a frame's budget.
#pragma once
#include <vector>

#include "perf/frames/frame_run.hpp"

namespace sinew::perf {

// Calibrated so that the middle one takes 0.9 of the budget.
std::vector<FrameCost> run_yardstick(float budget_us, uint32_t frames);

}  // namespace sinew::perf
