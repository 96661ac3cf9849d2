// knn_start.cpp  Checks examples.
#include "rods/knn_start.hpp"

#include <algorithm>
#include <cmath>

#include "core/status.hpp"

namespace sinew::rods {

Status check_examples(const StartExamples* examples) noexcept {
  const size_t numbers = examples ? examples->inputs.size() : 0, rows = numbers / simd::kRodStartInputs;
  if (rows < simd::kRodNeighbours || rows > kMostExamples) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "RodSettings::examples holds %zu; kKnn needs %u to %u", rows,
                             simd::kRodNeighbours, kMostExamples);
  }
  if (numbers != rows * simd::kRodStartInputs || examples->answers.size() != rows * simd::kRodStartNumbers) {
    return core::make_status(
        StatusCode::kInvalidArgument,
        "RodSettings::examples holds %zu numbers of inputs and %zu of answers; give %u and %u "
        "an example",
        numbers, examples->answers.size(), simd::kRodStartInputs, simd::kRodStartNumbers);
  }
  for (const auto list : {examples->inputs, examples->answers}) {
    const auto bad = std::ranges::find_if(list, [](float v) { return !std::isfinite(v); });
    if (bad != list.end()) {
      return core::make_status(StatusCode::kNotFinite,
                               "RodSettings::examples: number %zu is not finite; leave it out",
                               static_cast<size_t>(bad - list.begin()));
    }
  }
  return {};
}

simd::RodStartExamples start_examples(const StartExamples& examples) noexcept {
  return {examples.inputs.data(), examples.answers.data(),
          static_cast<uint32_t>(examples.inputs.size() / simd::kRodStartInputs)};
}

}  // namespace sinew::rods
