// kernels.hpp  Kernels of the methods that rods are compared with, beside the runtime's
// (kernels/rods/rod_job.hpp).
#pragma once
#include "kernels/rods/rod_job.hpp"

namespace sinew::baker {

struct CgLimits {
  float tolerance = 1e-4f;         // cg-inl.hpp; 1e-7 to 1
  uint32_t max_iterations = 1000;  // 1 to 100000
};

// A guess is the mean of the examples whose inputs are nearest.
struct ExampleRows {
  const float* inputs;   // [count][kRodStartInputs]
  const float* answers;  // [count][kRodStartNumbers]
  uint32_t count;        // at least kNeighbours
};
inline constexpr uint32_t kNeighbours = 3;  // Shao et al. 2021, Sec. 4

// For one width of a group; calls work on every lane.
struct RodResearchCalls {
  // Before the first iteration of cg, which measures its residuals by what this finds; the first iterate
  // stays.
  void (*measure_cg)(const simd::RodJob& job);
  // In place of simd::RodCalls::direct. Adds what all strands took to `iterations`.
  uint32_t (*cg)(const simd::RodJob& job, const CgLimits& limits, uint32_t* iterations);
  uint32_t (*local)(const simd::RodJob& job, uint32_t sweeps);
  // In place of simd::RodStartCalls::add_network.
  void (*add_nearest)(const simd::RodJob& job, const simd::RodStartJob& start, const ExampleRows& examples);
};

struct RodResearchTable {
  int64_t target;  // as simd::Kernels has it
  RodResearchCalls wide, narrow;
};

// Of the runtime's active instruction set; width 4 or 16.
const RodResearchCalls& rod_research_calls(uint32_t width) noexcept;

}  // namespace sinew::baker
