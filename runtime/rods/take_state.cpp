// take_state.cpp  The state of one batch into another of the same strands.
#include <algorithm>

#include "core/status.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {

Status RodBatch::take_state(const RodBatch& from) noexcept {
  const bool alike = from.strand_count_ == strand_count_ && from.segment_count_ == segment_count_ &&
                     std::equal(parents_, parents_ + segment_count_, from.parents_);
  if (!alike) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "the other batch has %u strands of %u segments, this one %u of %u, or other "
                             "parents; give one made of the same strands",
                             from.strand_count_, from.segment_count_, strand_count_, segment_count_);
  }
  const size_t groups = (size_t{strand_count_} + width_ - 1) / width_;
  std::copy_n(from.records_, groups * segment_count_ * simd::kRodKeptFields * width_, records_);
  teleported_ = from.teleported_;
  return {};
}

}  // namespace sinew::rods
