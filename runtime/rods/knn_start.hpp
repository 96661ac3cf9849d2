// knn_start.hpp  Examples for a batch with RodStart::kKnn: what a learned start is told, and the answer.
#pragma once
#include <span>

#include "simd/rod_start_job.hpp"
#include "sinew/status.hpp"

namespace sinew::rods {

// Views, whose memory outlives the batch. Rows of a segment each: inputs [count][kRodStartInputs] as
// simd/rod_start_job.hpp has them, answers [count][kRodStartNumbers] in the same measure.
struct StartExamples {
  std::span<const float> inputs, answers;
};

inline constexpr uint32_t kMostExamples = 1u << 20;

// Refused: none, rows that are cut, another count of answers than of inputs, less than kRodNeighbours, more
// than kMostExamples, a number that is not finite. O(count).
Status check_examples(const StartExamples* examples) noexcept;

simd::RodStartExamples start_examples(const StartExamples& examples) noexcept;

}  // namespace sinew::rods
