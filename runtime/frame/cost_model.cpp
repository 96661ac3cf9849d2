// cost_model.cpp  What a tick of an asset costs.
#include "frame/cost_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew::frame {

void CostEstimate::observe(float sample_us) noexcept {
  constexpr float kWeight = 0.125f, kFarthest = 2, kSmallest_us = 1e-3f;
  if (!std::isfinite(sample_us) || sample_us < 0) return;
  observed_ = true;
  const float held = std::clamp(sample_us, estimate_us_ / kFarthest, estimate_us_ * kFarthest);
  // From an estimate of zero (nothing baked) a ratio cannot be formed.
  estimate_us_ = estimate_us_ < kSmallest_us ? sample_us : estimate_us_ + kWeight * (held - estimate_us_);
}

void CostEstimate::relax() noexcept {
  constexpr float kShare = 0.01f;
  if (!std::exchange(observed_, false)) estimate_us_ += kShare * (baked_us_ - estimate_us_);
}

void Capacity::observe(float total_us, float budget_us, bool denied) noexcept {
  constexpr float kEarly = 0.85f, kRaise = 0.02f, kLower = 0.95f, kLeast = 0.25f, kMost = 64;
  if (total_us > budget_us)
    scale_ *= kLower;
  else if (denied && total_us < kEarly * budget_us)
    scale_ += kRaise;
  scale_ = std::clamp(scale_, kLeast, kMost);
}

}  // namespace sinew::frame
