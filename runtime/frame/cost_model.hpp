// cost_model.hpp  What a tick of an asset costs: the baked number, corrected by what the clock says.
#pragma once
#include <cstdint>

#include "sinew/types.hpp"

namespace sinew::frame {

// A running estimate that one preempted measurement cannot move far: a sample counts as at most twice and at
// least half of the estimate, with weight 1/8.
class CostEstimate {
 public:
  CostEstimate() noexcept = default;
  explicit CostEstimate(float baked_us) noexcept : baked_us_(baked_us), estimate_us_(baked_us) {}
  float baked_us() const noexcept { return baked_us_; }
  float estimate_us() const noexcept { return estimate_us_; }
  void observe(float sample_us) noexcept;  // not finite or negative: ignored
  // Once a step. Without an observation since the last call: drifts back to the baked number, so that an
  // estimate that is too high to be scheduled is tried again.
  void relax() noexcept;

 private:
  float baked_us_ = 0, estimate_us_ = 0;
  bool observed_ = false;
};

struct CostModel {                // of one asset
  CostEstimate tick[kTierCount];  // by Tier; of the simulated ones: poses, drive, tissue, guard
  CostEstimate base;  // what each instance takes in a step whatever its tier: pose, extrapolation, publishing
};

// The share of the budget that may be handed out in time mode. On one thread the estimates add up to the
// step's time (scale 1); on several they overlap. How far is not asked but found: a step that ended early
// although instances were denied raises the scale a little, a step over budget lowers it more.
class Capacity {
 public:
  float scale() const noexcept { return scale_; }
  void observe(float total_us, float budget_us, bool denied) noexcept;

 private:
  float scale_ = 1;
};

}  // namespace sinew::frame
