// step_batch.cpp  One step of a batch, and what is done where a strand cannot be simulated on.
#include <algorithm>
#include <limits>

#include "core/floating_point.hpp"
#include "core/status.hpp"
#include "kernels/kernels.hpp"
#include "rods/rod_batch.hpp"
#include "rods/solver/strand_packer.hpp"

namespace sinew::rods {
namespace {

const simd::RodCalls& calls(uint32_t width) {
  const simd::RodKernels& kernels = *simd::kernels().rods;
  return width == 16 ? kernels.wide : kernels.narrow;
}

}  // namespace

simd::RodJob RodBatch::group_job(uint32_t group, float dt_s, float* scratch) const noexcept {
  return {.records = records_ + size_t{group} * segment_count_ * simd::kRodKeptFields * width_,
          .scratch = scratch,
          .work = work_,
          .lanes = lanes_ + size_t{group} * simd::kLaneFields * width_,
          .parents = slot_parents_,
          .segments = segment_count_,
          .dt_s = dt_s,
          .force_s = dt_s,
          .tolerance_rad = settings_.tolerance_rad,
          .start_from_zero = settings_.start == RodStart::kZero};
}

simd::RodJob RodBatch::home_job(uint32_t place, float dt_s, const RodCollider& collider) const noexcept {
  simd::RodJob job = group_job(collider.places_.homes[place], dt_s, collider.scratch(place));
  collider.give(&job, place);
  return job;
}

// Its strands are to be iterated.
void RodBatch::activate(uint32_t group, const simd::RodJob& job) const noexcept {
  const uint32_t count = std::min(width_, strand_count_ - group * width_);
  for (uint32_t i = 0; i < width_; ++i) job.lanes[simd::kLaneActive * width_ + i] = i < count ? 1.0f : 0.0f;
  std::fill_n(job.lanes + simd::kLaneLargestShare * width_, width_, simd::kRodLargestShare);
}

void RodBatch::begin_group(uint32_t group, const simd::RodJob& job) const noexcept {
  activate(group, job);
  make_start(group, job);
  calls(width_).predict(job);
  const RodSolver& solver = settings_.solver;
  if (solver.begin) solver.begin(solver.self, job, width_);
}

// A group, if it has strands to iterate. Returns how many are not converged.
uint32_t RodBatch::iterate(const simd::RodJob& job) const noexcept {
  const float* lanes = job.lanes + simd::kLaneActive * width_;
  const bool any = std::any_of(lanes, lanes + width_, [](float x) { return x != 0; });
  if (!any) return 0;
  const RodSolver& solver = settings_.solver;
  return solver.iterate ? solver.iterate(solver.self, job, width_) : calls(width_).direct(job);
}

void RodBatch::iterate_homes(float dt_s, const RodCollider& collider) const noexcept {
  const GroupRange& range = collider.places_.range;
  for (uint32_t k = 0; k < range.groups; ++k) iterate(home_job(range.first_place + k, dt_s, collider));
}

// To behind the first iteration, which `left` may follow. Returns how many strands are not converged.
uint32_t RodBatch::begin_range(uint32_t first_group, float dt_s, RodCollider* collider,
                               uint32_t left) const noexcept {
  collider->open_range(first_group);
  const GroupRange range = collider->places_.range;
  for (uint32_t k = 0; k < range.groups; ++k) {
    begin_group(first_group + k, group_job(first_group + k, dt_s, collider->scratch(range.first_place + k)));
  }
  collider->begin_range(*this, dt_s);
  iterate_homes(dt_s, *collider);
  const uint32_t active = collider->settle(*this, left);
  if (active > 0 && left > 0) StrandPacker{*collider, *this}.add();
  return active;
}

// The next iteration of `active` strands; the same.
uint32_t RodBatch::go_on(float dt_s, RodCollider* collider, uint32_t active, uint32_t left) const noexcept {
  StrandPacker{*collider, *this}.pack(active);
  collider->assemble(*this);
  iterate_homes(dt_s, *collider);
  const simd::RodJob job = group_job(collider->places_.homes[0], dt_s, collider->scratch(0));
  for (uint32_t k = 0; k * width_ < collider->places_.packed_count; ++k)
    iterate(collider->packed_job(job, k));
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
      continue;
    }
    if (!ended) forget_start(first + i);
    // All joints open so far, one after the other, are what is spared of half a segment.
    const float closed = static_cast<float>(kMostReach - 1) / 2 / static_cast<float>(segment_count_);
    if (!ended || lane(simd::kLaneGapSquare) > closed * closed)
      report->rejoined += rejoin(first + i, ended, job.dt_s);
  }
}

void RodBatch::end_range(const GroupRange& range, float dt_s, RodCollider* collider,
                         RodReport* report) noexcept {
  collider->end_range(*this, range, dt_s, report);
  for (uint32_t k = 0; k < range.groups; ++k) {
    end_group(range.first_group + k, home_job(range.first_place + k, dt_s, *collider), report);
  }
}

void RodBatch::step_alone(uint32_t group, float dt_s, RodReport* report) noexcept {
  const simd::RodJob job = group_job(group, dt_s, scratch_);
  begin_group(group, job);
  for (uint32_t left = settings_.max_iterations; left > 0 && iterate(job) > 0; --left) continue;
  end_group(group, job, report);
}

// From a group on, until such as have strands that go on after the first iteration fill the collider's
// places; what has none ends before the next begins, while the processor's nearer cache has it. Returns the
// group behind them, and into `active` how many strands go on.
uint32_t RodBatch::begin_together(uint32_t group, float dt_s, RodCollider* collider, RodReport* report,
                                  uint32_t* active) noexcept {
  collider->begin_groups();
  while (group < group_count() && collider->has_place()) {
    const uint32_t going = begin_range(group, dt_s, collider, settings_.max_iterations - 1);
    const GroupRange range = collider->places_.range;
    group += range.groups, *active += going;
    if (going > 0) continue;
    end_range(range, dt_s, collider, report);
    collider->give_back(range);
  }
  collider->join_ranges();
  return group;
}

// Returns the group behind those that it stepped.
uint32_t RodBatch::step_together(uint32_t group, float dt_s, RodCollider* collider,
                                 RodReport* report) noexcept {
  uint32_t active = 0, left = settings_.max_iterations - 1;
  group = begin_together(group, dt_s, collider, report, &active);
  while (active > 0 && left > 0) active = go_on(dt_s, collider, active, --left);
  StrandPacker{*collider, *this}.unpack();
  for (uint32_t k = 0; k < collider->places_.range_count; ++k) {
    end_range(collider->places_.ranges[k], dt_s, collider, report);
  }
  return group;
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
  if (collider && !settings_.solver.knows_contacts) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "RodSettings::solver knows no contacts; step the batch without a collider");
  }
  const core::FloatingPointScope mode;
  RodReport made;
  made.teleported = teleported_;
  teleported_ = 0;
  if (collider) collider->begin_step();
  for (uint32_t g = 0; g < group_count();) {
    if (!collider) {
      step_alone(g++, dt_s, &made);
    } else {
      g = step_together(g, dt_s, collider, &made);
    }
  }
  if (collider) collider->end_step(dt_s, &made);
  newest_ = (newest_ + 1) % simd::kRodStartAges;
  if (report) *report = made;
  return {};
}

}  // namespace sinew::rods
