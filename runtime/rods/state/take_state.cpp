// take_state.cpp  The state of one batch into another of the same strands.
#include <algorithm>

#include "core/status.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {

void RodBatch::take_history(const RodBatch& from) noexcept {
  const size_t groups = (size_t{strand_count_} + width_ - 1) / width_,
               rows = groups * segment_count_ * width_;
  for (size_t group = 0; group < groups; ++group) {
    const size_t at = (group * simd::kLaneFields + simd::kLaneKnownSteps) * width_;
    if (from.history_) {
      std::copy_n(from.lanes_ + at, width_, lanes_ + at);
    } else {
      std::fill_n(lanes_ + at, width_, 0.0f);
    }
  }
  newest_ = from.newest_;
  if (from.history_)
    std::copy_n(from.history_, rows * simd::kRodStartAges * simd::kRodStartNumbers, history_);
  if (!inputs_) return;
  if (!from.inputs_) {
    // Continued as far as it goes; what corrects has nothing to go by yet.
    for (uint32_t strand = 0; strand < strand_count_; ++strand)
      known_steps(strand) = std::min(known_steps(strand), float{simd::kRodStartKnown});
    return;
  }
  std::copy_n(from.inputs_, rows * simd::kRodStartInputs, inputs_);
  std::copy_n(from.continued_, rows * simd::kRodStartNumbers, continued_);
  std::copy_n(from.scales_, groups * simd::kRodStartTriples * width_, scales_);
}

Status RodBatch::take_state(const RodBatch& from) noexcept {
  const bool alike = from.strand_count_ == strand_count_ && from.segment_count_ == segment_count_ &&
                     std::equal(parents_, parents_ + segment_count_, from.parents_) &&
                     std::equal(slots_, slots_ + segment_count_, from.slots_);
  if (!alike) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "the other batch has %u strands of %u segments, this one %u of %u, or other "
                             "parents or held ends; give one made of the same strands",
                             from.strand_count_, from.segment_count_, strand_count_, segment_count_);
  }
  const size_t groups = (size_t{strand_count_} + width_ - 1) / width_;
  std::copy_n(from.records_, groups * segment_count_ * simd::kRodKeptFields * width_, records_);
  teleported_ = from.teleported_;
  if (history_) take_history(from);
  return {};
}

}  // namespace sinew::rods
