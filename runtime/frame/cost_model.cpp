// cost_model.cpp  What a tick of an asset costs.
#include "frame/cost_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew::frame {

void CostEstimate::observe(float sample_us) noexcept {
  constexpr float kFarthest = 2, kSmallest_us = 1e-3f, kStep = 0.02f, kAbove = 0.95f;
  if (!std::isfinite(sample_us) || sample_us < 0) return;
  // From an estimate of zero (nothing baked) a ratio cannot be formed.
  if (estimate_us_ < kSmallest_us) estimate_us_ = sample_us;
  sum_us_ += std::clamp(sample_us, estimate_us_ / kFarthest, estimate_us_ * kFarthest);
  tail_ *= 1 + kStep * (sample_us > p95_us() ? kAbove : kAbove - 1);
  tail_ = std::clamp(tail_, 1.0f, kWidest);
  ++samples_;
  measured_ = true;
}

void CostEstimate::settle() noexcept {
  constexpr float kWeight = 0.125f, kDrift = 0.01f;
  if (samples_ > 0)
    estimate_us_ += kWeight * (sum_us_ / static_cast<float>(samples_) - estimate_us_);
  else if (baked_us_ > 0)
    estimate_us_ += kDrift * (baked_us_ - estimate_us_);
  sum_us_ = 0;
  samples_ = 0;
}

void CostModel::settle() noexcept {
  for (CostEstimate& estimate : tick) estimate.settle();
  publish.settle();
}

void Capacity::observe(float spent, bool denied, bool late) noexcept {
  constexpr float kFull = 0.985f, kEmptiest = 0.5f, kGain = 0.1f, kLate = 0.99f;
  constexpr float kLeast = 0.05f, kMost = 64;
  const float whole = kFull / std::clamp(spent, kEmptiest, 1 / kEmptiest);
  float wanted = 1;
  if (late || spent > 1)
    wanted = std::min(kLate, 1 + 2 * kGain * (whole - 1));
  else if (denied && whole > 1)
    wanted = 1 + kGain * (whole - 1);
  wanted_[std::exchange(next_, (next_ + 1) % 3)] = wanted;
  const float middle = std::max(std::min(wanted_[0], wanted_[1]),
                                std::min(std::max(wanted_[0], wanted_[1]), wanted_[2]));
  scale_ = std::clamp(scale_ * middle, kLeast, kMost);
}

}  // namespace sinew::frame
