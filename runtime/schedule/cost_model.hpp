// cost_model.hpp  What a tick of an asset costs: the baked number, corrected by what the clock says.
#pragma once
#include <algorithm>
#include <cstdint>

#include "pack/format.hpp"
#include "sinew/types.hpp"

namespace sinew::frame {

// A running estimate that a preempted measurement cannot move far: a sample counts as at most twice and at
// least half of the estimate; the mean of a step's samples has weight 1/8, unless said otherwise, and up to a
// half after steps without any. Beside it what 95 and what 99 of 100 samples do not exceed, by their ranks
// alone, at most kWidest times the estimate.
class CostEstimate {
 public:
  static constexpr float kWidest = 3;
  struct Correction {
    float drift = 0.01f;  // in a step without a sample, of the way back to the baked number
    float rise = 0.125f;  // a step's weight where its samples are above the estimate
  };

  CostEstimate() noexcept = default;
  explicit CostEstimate(float baked_us) noexcept : CostEstimate(baked_us, Correction()) {}
  CostEstimate(float baked_us, const Correction& by) noexcept
      : baked_us_(baked_us), estimate_us_(baked_us), by_(by), known_(true), is_baked_(true) {}
  float baked_us() const noexcept { return baked_us_; }
  float estimate_us() const noexcept { return estimate_us_; }
  float p95_us() const noexcept { return std::max(estimate_us_ * tail_, last_p95_us_); }
  float p99_us() const noexcept { return std::max(estimate_us_ * far_tail_, last_p99_us_); }
  bool is_known() const noexcept { return known_; }
  void observe(float sample_us) noexcept;  // not finite or negative: ignored
  // Once a step. Without a sample since the last call: drifts back to the baked number and a usual tail, so
  // that what is too high to be scheduled is tried again.
  void settle() noexcept;

 private:
  void correct(float mean_us) noexcept;
  void drift() noexcept;

  float baked_us_ = 0, estimate_us_ = 0, tail_ = 2, far_tail_ = 2.5f;
  // Without samples the estimate falls to what is worth a trial; the tails remember longer what it took.
  float last_p95_us_ = 0, last_p99_us_ = 0;
  float trust_ = 1;  // in the estimate: falls as it drifts
  Correction by_;
  float sum_us_ = 0;
  uint32_t samples_ = 0, unsampled_ = 0;  // in this step; steps in turn
  bool known_ = false;                    // baked, at whatever cost, or measured
  bool is_baked_ = false;
};

struct CostModel {  // of one asset
  // Of the simulated tiers, at a level of control graphs: poses, drive, tissue, rods, guard.
  CostEstimate& of(Tier tier, uint32_t level) noexcept { return tick[static_cast<size_t>(tier)][level]; }
  const CostEstimate& of(Tier tier, uint32_t level) const noexcept {
    return tick[static_cast<size_t>(tier)][level];
  }
  CostEstimate tick[kTierCount][pack::kMostGraphLevels];
  CostEstimate publish;  // a step, of what is displaced: pose, publishing
  // Of a simulated tier, where a step ends between ticks: a provisional step, as a share of a tick.
  CostEstimate& between(Tier tier) noexcept {
    return tier == Tier::kNetwork ? between_network : between_modal;
  }
  const CostEstimate& between(Tier tier) const noexcept {
    return tier == Tier::kNetwork ? between_network : between_modal;
  }
  CostEstimate between_network{0.45f}, between_modal{1};  // as perf_between has them
  CostEstimate enter{0};  // what the first tick of a simulation takes beyond a tick: cold memory, a history
  // Likewise the first on a finer control graph: seldom, and only half forgotten in twelve seconds, but one
  // that was preempted is not to be the last.
  static constexpr CostEstimate::Correction kSeldom{.drift = 0.001f};
  CostEstimate change{0, kSeldom};
  CostEstimate come_back;  // the step in which one comes into view: cold memory, and nothing simulated
  void settle() noexcept;
};

// The share of the budget that may be handed out in time mode: on one thread the estimates add up to the
// step's time (scale 1, and a little below it), on several they overlap. How far is not asked but found. A
// frame that ended early although a budget denied one raises the scale; one whose deadline came before all
// was done lowers it: a little for each, for fewer shall be late than one in twenty, and by what was left
// undone in the middle one of the last three frames, so that a lost worker is noticed at once and a single
// preemption is not taken for one.
class Capacity {
 public:
  float scale() const noexcept { return scale_; }
  // spent: of what the tasks had, 1 in time. undone: of what was planned, 0 in time.
  void observe(float spent, float undone, bool denied) noexcept;

 private:
  float scale_ = 0.95f;
  float undone_[3] = {};
  uint32_t next_ = 0;
};

}  // namespace sinew::frame
