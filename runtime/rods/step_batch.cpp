// step_batch.cpp  One step of a batch, and what is done where a strand cannot be simulated on.
#include <algorithm>
#include <limits>

#include "core/flush_denormals.hpp"
#include "core/status.hpp"
#include "rods/rod_batch.hpp"
#include "rods/strand_packer.hpp"
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
          .scratch = collider ? collider->scratch(group) : scratch_,
          .work = work_,
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

// A group, if it has strands to iterate. Returns how many are not converged.
uint32_t RodBatch::iterate(const simd::RodJob& job) const noexcept {
  const float* lanes = job.lanes + simd::kLaneActive * width_;
  const bool any = std::any_of(lanes, lanes + width_, [](float x) { return x != 0; });
  return any ? iteration(calls(width_), settings_.solver)(job) : 0;
}

uint32_t RodBatch::iterate(uint32_t first_group, uint32_t groups, float dt_s,
                           const RodCollider* collider) const noexcept {
  uint32_t active = 0;
  for (uint32_t g = first_group; g < first_group + groups; ++g) {
    simd::RodJob job = group_job(g, dt_s, collider);
    if (collider) collider->give(&job, g - collider->first_home_);
    active += iterate(job);
  }
  return active;
}

// To behind the first iteration, which `left` may follow. Returns how many strands are not converged.
uint32_t RodBatch::begin_range(uint32_t first_group, uint32_t groups, float dt_s, RodCollider* collider,
                               uint32_t left) const noexcept {
  for (uint32_t g = first_group; g < first_group + groups; ++g) begin_group(g, group_job(g, dt_s, collider));
  if (!collider) return iterate(first_group, groups, dt_s, collider);
  collider->begin_range(*this, first_group, groups, dt_s);
  iterate(first_group, groups, dt_s, collider);
  const uint32_t active = collider->settle(*this, left);
  if (left > 0) StrandPacker{*collider, *this}.add();
  return active;
}

// The next iteration of `active` strands; the same.
uint32_t RodBatch::go_on(uint32_t first_group, uint32_t groups, float dt_s, RodCollider* collider,
                         uint32_t active, uint32_t left) const noexcept {
  if (!collider) return iterate(first_group, groups, dt_s, collider);
  StrandPacker{*collider, *this}.pack(active);
  collider->assemble(*this);
  iterate(first_group, groups, dt_s, collider);
  const simd::RodJob job = group_job(first_group, dt_s, collider);
  for (uint32_t k = 0; k * width_ < collider->packed_count_; ++k) iterate(collider->packed_job(job, k));
  return collider->settle(*this, left);
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

void RodBatch::end_range(uint32_t first_group, uint32_t groups, float dt_s, RodCollider* collider,
                         RodReport* report) noexcept {
  if (collider) collider->end_range(*this, first_group, dt_s, report);
  for (uint32_t g = first_group; g < first_group + groups; ++g) {
    simd::RodJob job = group_job(g, dt_s, collider);
    if (collider) collider->give(&job, g - collider->first_home_);
    end_group(g, job, report);
  }
}

void RodBatch::step_groups(uint32_t first_group, uint32_t groups, float dt_s, RodCollider* collider,
                           RodReport* report) noexcept {
  const uint32_t end = first_group + groups, in_range = collider ? collider->groups_of_range() : 1;
  uint32_t active = 0, left = settings_.max_iterations - 1;
  if (collider) collider->begin_groups(first_group);
  for (uint32_t g = first_group; g < end; g += in_range) {
    active += begin_range(g, in_range, dt_s, collider, left);
  }
  if (collider) collider->join_ranges(groups);
  while (active > 0 && left > 0) active = go_on(first_group, groups, dt_s, collider, active, --left);
  if (collider) StrandPacker{*collider, *this}.unpack();
  for (uint32_t g = first_group; g < end; g += in_range) end_range(g, in_range, dt_s, collider, report);
  if (collider) collider->end_groups(*this, dt_s, report);
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
  const uint32_t at_once = collider ? collider->groups_at_once() : 1;
  if (collider) collider->begin_step();
  for (uint32_t g = 0; g < groups; g += at_once) {
    step_groups(g, std::min(at_once, groups - g), dt_s, collider, &made);
  }
  if (collider) collider->end_step(dt_s, &made);
  newest_ = (newest_ + 1) % simd::kRodStartAges;
  if (report) *report = made;
  return {};
}

}  // namespace sinew::rods
