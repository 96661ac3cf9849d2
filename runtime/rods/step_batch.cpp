// step_batch.cpp  One step of a batch, and what is done where a strand cannot be simulated on.
#include <algorithm>
#include <limits>

#include "core/flush_denormals.hpp"
#include "core/status.hpp"
#include "rods/contact_forces.hpp"
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

simd::RodJob RodBatch::group_job(uint32_t group, float dt_s, const RodCollider* collider) const noexcept {
  return {.records = records_ + size_t{group} * segment_count_ * simd::kRodKeptFields * width_,
          .scratch = collider ? collider->scratch(*this, group) : scratch_,
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

void RodBatch::begin_group(uint32_t group, const simd::RodJob& job) const noexcept {
  const simd::RodCalls& call = calls(width_);
  const uint32_t count = std::min(width_, strand_count_ - group * width_);
  for (uint32_t i = 0; i < width_; ++i) job.lanes[simd::kLaneActive * width_ + i] = i < count ? 1.0f : 0.0f;
  std::fill_n(job.lanes + simd::kLaneLargestShare * width_, width_, simd::kRodLargestShare);
  make_start(group, job);
  call.predict(job);
  if (settings_.solver == RodSolver::kCg) call.measure_cg(job);
}

// Once, those of the groups that have strands to iterate. Returns how many strands are not converged.
uint32_t RodBatch::iterate(uint32_t first_group, uint32_t groups, float dt_s,
                           const RodCollider* collider) const noexcept {
  const auto iterate = iteration(calls(width_), settings_.solver);
  uint32_t active = 0;
  for (uint32_t g = first_group; g < first_group + groups; ++g) {
    simd::RodJob job = group_job(g, dt_s, collider);
    if (collider) collider->give(&job, g);
    const float* lanes = job.lanes + simd::kLaneActive * width_;
    if (std::any_of(lanes, lanes + width_, [](float x) { return x != 0; })) active += iterate(job);
  }
  return active;
}

void RodBatch::end_group(uint32_t group, const simd::RodJob& job, RodReport* report) noexcept {
  if (settings_.report_residual) calls(width_).residual(job);
  calls(width_).finish(job);
  const uint32_t first = group * width_, count = std::min(width_, strand_count_ - first);
  for (uint32_t i = 0; i < count; ++i) {
    const auto lane = [&](uint32_t field) { return job.lanes[field * width_ + i]; };
    const auto iterations = static_cast<uint32_t>(lane(simd::kLaneIterations));
    report->iterations = std::max(report->iterations, iterations);
    report->iterations_sum += iterations;
    report->cg_iterations += static_cast<uint32_t>(lane(simd::kLaneCgIterations));
    if (settings_.report_residual) {
      const float residual =
          lane(simd::kLaneBroken) != 0 ? std::numeric_limits<float>::infinity() : lane(simd::kLaneResidual);
      report->residual = residual <= report->residual ? report->residual : residual;
    }
    report->unconverged += lane(simd::kLaneActive) != 0;
    report->recovered += lane(simd::kLaneBroken) != 0;
    const bool ended = lane(simd::kLaneActive) == 0 && lane(simd::kLaneBroken) == 0;
    float& known = job.lanes[simd::kLaneKnownSteps * width_ + i];
    known = ended ? std::min(known + 1, simd::kRodStartKnown + 1.0f) : 0;
    if (lane(simd::kLaneBroken) != 0) {
      recover(first + i);
    } else if (lane(simd::kLaneActive) != 0) {
      report->rejoined += rejoin(first + i, job.dt_s);
    }
  }
}

void RodBatch::step_groups(uint32_t first_group, uint32_t groups, float dt_s, RodCollider* collider,
                           RodReport* report) noexcept {
  const uint32_t end = first_group + groups;
  for (uint32_t g = first_group; g < end; ++g) begin_group(g, group_job(g, dt_s, collider));
  if (collider) collider->begin_range(*this, first_group, groups, dt_s);
  for (uint32_t k = 0; k < settings_.max_iterations; ++k) {
    uint32_t active = iterate(first_group, groups, dt_s, collider);
    if (collider) active = collider->settle(*this, settings_.max_iterations - 1 - k);
    if (active == 0) break;
  }
  if (collider) collider->end_range(*this, dt_s, report);
  for (uint32_t g = first_group; g < end; ++g) {
    simd::RodJob job = group_job(g, dt_s, collider);
    if (collider) collider->give(&job, g);
    end_group(g, job, report);
  }
}

Status RodBatch::step(float dt_s, RodReport* report) noexcept { return step(dt_s, nullptr, report); }

Status RodBatch::step(float dt_s, RodCollider* collider, RodReport* report) noexcept {
  if (!(dt_s > 0 && dt_s <= 1)) {
    return core::make_status(StatusCode::kInvalidArgument, "dt_s is %g; give a number above 0, at most 1",
                             static_cast<double>(dt_s));
  }
  if (collider && !collider->fits(*this)) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "the collider is for %u strands of %u segments, the batch has %u of %u; create "
                             "one for it",
                             collider->strand_count_, collider->segment_count_, strand_count_,
                             segment_count_);
  }
  if (collider && settings_.solver == RodSolver::kLocal) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "RodSettings::solver kLocal knows no contacts; create the batch with kDirect or "
                             "kCg, or step it without a collider");
  }
  const core::FlushDenormals flush;
  RodReport made;
  made.teleported = teleported_;
  teleported_ = 0;
  const uint32_t groups = (strand_count_ + width_ - 1) / width_;
  const uint32_t at_once = collider && collider->settings_.rods_collide ? groups : 1;
  if (collider) collider->begin_step();
  for (uint32_t g = 0; g < groups; g += at_once) step_groups(g, at_once, dt_s, collider, &made);
  if (collider && settings_.report_residual) {
    made.residual = std::max(made.residual, static_cast<float>(ContactForces{*collider, *this}.miss()));
  }
  if (collider) collider->end_step(dt_s, &made);
  newest_ = (newest_ + 1) % simd::kRodStartAges;
  if (report) *report = made;
  return {};
}

}  // namespace sinew::rods
