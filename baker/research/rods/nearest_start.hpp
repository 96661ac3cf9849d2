// nearest_start.hpp  Starts of rods' steps corrected by the nearest of given examples: the learned start's
// baseline.
#pragma once
#include <span>

#include "baker/research/rods/kernels.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::baker {

// Outlives the batches that are made with it, where it is.
class NearestStart {
 public:
  // Views, whose memory outlives it. Rows of a segment each: inputs [count][kRodStartInputs] as
  // kernels/rods/rod_start_job.hpp has them, answers [count][kRodStartNumbers] in the same measure. Throws
  // BadInput for rows that are cut, less than kNeighbours, more than a million, numbers that are not finite.
  NearestStart(std::span<const float> inputs, std::span<const float> answers);
  const ExampleRows& rows() const noexcept { return rows_; }
  // For RodSettings::correction, with the start kContinued.
  rods::RodCorrection correction() noexcept;

 private:
  ExampleRows rows_;
};

}  // namespace sinew::baker
