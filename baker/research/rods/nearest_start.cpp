// nearest_start.cpp  see nearest_start.hpp.
#include "baker/research/rods/nearest_start.hpp"

#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kMostExamples = size_t{1} << 20;

void add_nearest(void* self, const simd::RodJob& job, const simd::RodStartJob& start, uint32_t width) {
  rod_research_calls(width).add_nearest(job, start, static_cast<NearestStart*>(self)->rows());
}

}  // namespace

NearestStart::NearestStart(std::span<const float> inputs, std::span<const float> answers) {
  const size_t count = inputs.size() / simd::kRodStartInputs;
  if (inputs.size() != count * simd::kRodStartInputs || answers.size() != count * simd::kRodStartNumbers) {
    throw BadInput("examples of starts: " + std::to_string(inputs.size()) + " numbers of inputs and " +
                   std::to_string(answers.size()) + " of outputs; give " +
                   std::to_string(simd::kRodStartInputs) + " and " + std::to_string(simd::kRodStartNumbers) +
                   " an example");
  }
  if (count < kNeighbours || count > kMostExamples) {
    throw BadInput("examples of starts: " + std::to_string(count) + "; give " + std::to_string(kNeighbours) +
                   " to " + std::to_string(kMostExamples));
  }
  for (const auto list : {inputs, answers}) {
    if (!std::ranges::all_of(list, [](float v) { return std::isfinite(v); }))
      throw BadInput("examples of starts: a number is not finite; leave it out");
  }
  rows_ = {inputs.data(), answers.data(), static_cast<uint32_t>(count)};
}

rods::RodCorrection NearestStart::correction() noexcept { return {add_nearest, this}; }

}  // namespace sinew::baker
