// cost_model.cpp  What a tick of an asset costs.
#include "schedule/cost_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew::frame {
namespace {

// Rests where the share `rank` of all samples lies below it.
void follow_rank(float sample, float rank, float* tail) noexcept {
  constexpr float kStep = 0.02f;
  *tail *= 1 + kStep * (sample > *tail ? rank : rank - 1);
  *tail = std::clamp(*tail, 1.0f, CostEstimate::kWidest);
}

}  // namespace

void CostEstimate::observe(float sample_us) noexcept {
  constexpr float kFarthest = 2, kSmallest_us = 1e-3f;
  if (!std::isfinite(sample_us) || sample_us < 0) return;
  // From an estimate of zero (nothing baked) a ratio cannot be formed.
  if (estimate_us_ < kSmallest_us) estimate_us_ = std::max(sample_us, kSmallest_us);
  sum_us_ += std::clamp(sample_us, estimate_us_ / kFarthest, estimate_us_ * kFarthest);
  follow_rank(sample_us / estimate_us_, 0.95f, &tail_);
  follow_rank(sample_us / estimate_us_, 0.99f, &far_tail_);
  ++samples_;
  known_ = true;
}

void CostEstimate::settle() noexcept {
  if (samples_ > 0)
    correct(sum_us_ / static_cast<float>(samples_));
  else
    drift();
  sum_us_ = 0;
  samples_ = 0;
}

void CostEstimate::correct(float mean_us) noexcept {
  constexpr float kWeight = 0.125f, kMost = 0.5f;
  const float weight = mean_us > estimate_us_ ? by_.rise : kWeight;
  estimate_us_ += std::max(weight, std::min(1 - trust_, kMost)) * (mean_us - estimate_us_);
  last_p95_us_ = last_p99_us_ = 0;
  unsampled_ = 0;
  trust_ = 1;
}

void CostEstimate::drift() noexcept {
  constexpr float kDrift = 0.01f, kUsualTail = 1.2f, kUsualFarTail = 1.4f;
  constexpr uint32_t kRemembers = 120;  // two seconds
  const float keeps = ++unsampled_ > kRemembers ? 1 - kDrift : 1;
  last_p95_us_ = keeps * p95_us();
  last_p99_us_ = keeps * p99_us();
  tail_ += kDrift * (kUsualTail - tail_);
  far_tail_ += kDrift * (kUsualFarTail - far_tail_);
  if (!is_baked_) return;
  estimate_us_ += by_.drift * (baked_us_ - estimate_us_);
  trust_ *= 1 - by_.drift;
}

void CostModel::settle() noexcept {
  for (auto& levels : tick)
    for (CostEstimate& estimate : levels) estimate.settle();
  publish.settle();
  between_network.settle();
  between_modal.settle();
  enter.settle();
  change.settle();
  come_back.settle();
}

void Capacity::observe(float spent, float undone, bool denied) noexcept {
  constexpr float kFull = 0.985f, kNearlyFull = 0.9f, kEmptiest = 0.5f;
  constexpr float kGain = 0.1f, kFineGain = 0.01f, kLate = 0.98f, kCatchUp = 0.5f;
  constexpr float kLeast = 0.05f, kMost = 64;
  undone_[std::exchange(next_, (next_ + 1) % 3)] = undone;
  const float middle =
      std::max(std::min(undone_[0], undone_[1]), std::min(std::max(undone_[0], undone_[1]), undone_[2]));
  if (undone > 0 || spent > 1)
    scale_ *= kLate * (1 - kCatchUp * std::min(middle, undone));
  else if (denied && spent < kFull)
    scale_ *= 1 + (spent < kNearlyFull ? kGain : kFineGain) * (kFull / std::max(spent, kEmptiest) - 1);
  scale_ = std::clamp(scale_, kLeast, kMost);
}

}  // namespace sinew::frame
