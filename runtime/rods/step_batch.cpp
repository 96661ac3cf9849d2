// step_batch.cpp  One step of a batch, and what is done where a strand cannot be simulated on.
#include <algorithm>

#include "core/flush_denormals.hpp"
#include "core/status.hpp"
#include "rods/rod_batch.hpp"
#include "simd/kernels.hpp"

namespace sinew::rods {
namespace {

const simd::RodCalls& calls(uint32_t width) {
  const simd::RodKernels& kernels = *simd::kernels().rods;
  return width == 16 ? kernels.wide : kernels.narrow;
}

using Iteration = uint32_t (*)(const simd::RodJob& job);
Iteration iteration(const simd::RodCalls& calls, RodSolver solver) {
  if (solver == RodSolver::kCg) return calls.cg;
  return solver == RodSolver::kLocal ? calls.local : calls.direct;
}

}  // namespace

simd::RodJob RodBatch::group_job(uint32_t group, float dt_s) const noexcept {
  return {.records = records_ + size_t{group} * segment_count_ * simd::kRodKeptFields * width_,
          .scratch = scratch_,
          .lanes = lanes_ + size_t{group} * simd::kLaneFields * width_,
          .parents = slot_parents_,
          .segments = segment_count_,
          .dt_s = dt_s,
          .tolerance_rad = settings_.tolerance_rad,
          .start_from_zero = settings_.start == RodStart::kZero,
          .cg_tolerance = settings_.cg_tolerance,
          .cg_iterations = settings_.cg_max_iterations,
          .local_sweeps = settings_.local_sweeps};
}

void RodBatch::step_group(uint32_t group, float dt_s, RodReport* report) noexcept {
  const simd::RodJob job = group_job(group, dt_s);
  const simd::RodCalls& call = calls(width_);
  const uint32_t first = group * width_, count = std::min(width_, strand_count_ - first);
  for (uint32_t i = 0; i < width_; ++i) job.lanes[simd::kLaneActive * width_ + i] = i < count ? 1.0f : 0.0f;
  make_start(group, job);
  call.predict(job);
  if (settings_.solver == RodSolver::kCg) call.measure_cg(job);
  const auto iterate = iteration(call, settings_.solver);
  for (uint32_t k = 0; k < settings_.max_iterations; ++k) {
    if (iterate(job) == 0) break;
  }
  if (settings_.report_residual) call.residual(job);
  call.finish(job);
  for (uint32_t i = 0; i < count; ++i) {
    const auto lane = [&](uint32_t field) { return job.lanes[field * width_ + i]; };
    const auto iterations = static_cast<uint32_t>(lane(simd::kLaneIterations));
    report->iterations = std::max(report->iterations, iterations);
    report->iterations_sum += iterations;
    report->cg_iterations += static_cast<uint32_t>(lane(simd::kLaneCgIterations));
    if (settings_.report_residual) report->residual = std::max(report->residual, lane(simd::kLaneResidual));
    report->unconverged += lane(simd::kLaneActive) != 0;
    report->recovered += lane(simd::kLaneBroken) != 0;
    const bool ended = lane(simd::kLaneActive) == 0 && lane(simd::kLaneBroken) == 0;
    float& known = job.lanes[simd::kLaneKnownSteps * width_ + i];
    known = ended ? std::min(known + 1, simd::kRodStartKnown + 1.0f) : 0;
    if (lane(simd::kLaneBroken) != 0) {
      recover(first + i);
    } else if (lane(simd::kLaneActive) != 0) {
      report->rejoined += rejoin(first + i, dt_s);
    }
  }
}

Status RodBatch::step(float dt_s, RodReport* report) noexcept {
  if (!(dt_s > 0 && dt_s <= 1)) {
    return core::make_status(StatusCode::kInvalidArgument, "dt_s is %g; give a number above 0, at most 1",
                             static_cast<double>(dt_s));
  }
  const core::FlushDenormals flush;
  RodReport made;
  made.teleported = teleported_;
  teleported_ = 0;
  for (uint32_t group = 0; group * width_ < strand_count_; ++group) step_group(group, dt_s, &made);
  newest_ = (newest_ + 1) % simd::kRodStartAges;
  if (report) *report = made;
  return {};
}

}  // namespace sinew::rods
