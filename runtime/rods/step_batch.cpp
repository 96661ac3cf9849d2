// step_batch.cpp  One step of a batch, and what is done where a strand cannot be simulated on.
#include <algorithm>

#include "core/flush_denormals.hpp"
#include "core/status.hpp"
#include "rods/rod_batch.hpp"
#include "rods/turn.hpp"
#include "simd/kernels.hpp"

namespace sinew::rods {
namespace {

const simd::RodCalls& calls(uint32_t width) {
  const simd::RodKernels& kernels = *simd::kernels().rods;
  return width == 16 ? kernels.wide : kernels.narrow;
}

}  // namespace

simd::RodJob RodBatch::group_job(uint32_t group, float dt_s) const noexcept {
  return {.records = records_ + size_t{group} * segment_count_ * simd::kRodKeptFields * width_,
          .scratch = scratch_,
          .lanes = lanes_ + size_t{group} * simd::kLaneFields * width_,
          .parents = parents_,
          .segments = segment_count_,
          .dt_s = dt_s,
          .tolerance_rad = settings_.tolerance_rad,
          .start_from_zero = settings_.start == RodStart::kZero,
          .cg_tolerance = settings_.cg_tolerance,
          .cg_iterations = settings_.cg_max_iterations};
}

void RodBatch::step_group(uint32_t group, float dt_s, RodReport* report) noexcept {
  const simd::RodJob job = group_job(group, dt_s);
  const simd::RodCalls& call = calls(width_);
  const uint32_t first = group * width_, count = std::min(width_, strand_count_ - first);
  for (uint32_t i = 0; i < width_; ++i) job.lanes[simd::kLaneActive * width_ + i] = i < count ? 1.0f : 0.0f;
  make_start(group, job);
  call.predict(job);
  if (settings_.solver == RodSolver::kCg) call.measure_cg(job);
  for (uint32_t k = 0; k < settings_.max_iterations; ++k) {
    if ((settings_.solver == RodSolver::kCg ? call.cg : call.direct)(job) == 0) break;
  }
  call.finish(job);
  for (uint32_t i = 0; i < count; ++i) {
    const auto lane = [&](uint32_t field) { return job.lanes[field * width_ + i]; };
    const auto iterations = static_cast<uint32_t>(lane(simd::kLaneIterations));
    report->iterations = std::max(report->iterations, iterations);
    report->iterations_sum += iterations;
    report->cg_iterations += static_cast<uint32_t>(lane(simd::kLaneCgIterations));
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

// Everything moves as a rigid body with the given segment; velocities turn along. Targets of other fixed
// segments stay where they are in the world.
void RodBatch::carry(uint32_t strand, uint32_t segment, const SegmentPose& to) noexcept {
  const SegmentPose from = pose(strand, segment);
  const Turn by = product(normalised(turn_of(to.orientation)), conjugate(turn_of(from.orientation)));
  const Units& units = units_[strand];
  for (uint32_t i = 0; i < segment_count_; ++i) {
    const SegmentPose old = pose(strand, i);
    const Vector arm =
        turned(by, {old.position_m[0] - from.position_m[0], old.position_m[1] - from.position_m[1],
                    old.position_m[2] - from.position_m[2]});
    const Vector speed = turned(by, {at(strand, i, simd::kRodVelocity), at(strand, i, simd::kRodVelocity + 1),
                                     at(strand, i, simd::kRodVelocity + 2)});
    const Turn q = normalised(product(by, turn_of(old.orientation)));
    for (uint32_t k = 0; k < 3; ++k) {
      const double place = (to.position_m[k] + arm[k] - units.origin_m[k]) / units.length_m;
      const double before = (old.position_m[k] - units.origin_m[k]) / units.length_m;
      at(strand, i, simd::kRodTarget + k) += static_cast<float>(before - place);
      put_place(strand, i, k, place);
      at(strand, i, simd::kRodVelocity + k) = static_cast<float>(speed[k]);
    }
    for (uint32_t k = 0; k < 4; ++k) at(strand, i, simd::kRodTurn + k) = static_cast<float>(q[k]);
  }
  for (uint32_t k = 0; k < 3; ++k) at(strand, segment, simd::kRodTarget + k) = 0;
  for (uint32_t k = 0; k < 4; ++k) {
    at(strand, segment, simd::kRodTargetTurn + k) = at(strand, segment, simd::kRodTurn + k);
  }
  ++teleported_;
}

}  // namespace sinew::rods
