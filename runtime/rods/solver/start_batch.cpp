// start_batch.cpp  Makes the starts of a group before its step: continued, and corrected by example.
#include <algorithm>
#include <cmath>

#include "kernels/kernels.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {
namespace {

const simd::RodStartCalls& calls(uint32_t width) {
  const simd::RodKernels& kernels = *simd::kernels().rods;
  return width == 16 ? kernels.wide.start : kernels.narrow.start;
}

}  // namespace

simd::RodStartJob RodBatch::start_job(uint32_t group) const noexcept {
  const size_t rows = size_t{group} * segment_count_ * width_;
  simd::RodStartJob job{};
  job.history = history_ + rows * simd::kRodStartAges * simd::kRodStartNumbers;
  job.newest = newest_;
  if (!inputs_) return job;
  job.inputs = inputs_ + rows * simd::kRodStartInputs;
  job.continued = continued_ + rows * simd::kRodStartNumbers;
  job.scales = scales_ + size_t{group} * simd::kRodStartTriples * width_;
  job.encodings = encodings_ ? encodings_ + rows * net_.latent : nullptr;
  job.planes = planes_;
  return job;
}

void RodBatch::make_start(uint32_t group, const simd::RodJob& job) const noexcept {
  if (!has_history()) return;
  const simd::RodStartJob start = start_job(group);
  const simd::RodStartCalls& call = calls(width_);
  call.continue_start(job, start);
  if (settings_.start == RodStart::kLearned) call.add_network(job, start, net_);
  const RodCorrection& correction = settings_.correction;
  if (correction.correct) correction.correct(correction.self, job, start, width_);
}

// What is told once: where a segment lies along the strand, in joints from the root over
// the most that any has, and what the network makes of the joints, of the rest shape that they were made
// with: what set_rest changes it is not told.
void RodBatch::tell_fixed_inputs() noexcept {
  if (!inputs_) return;
  const size_t groups = (size_t{strand_count_} + width_ - 1) / width_;
  float* place = scratch_;  // not yet in use
  place[0] = 0;
  for (uint32_t i = 1; i < segment_count_; ++i) place[i] = place[slot_parents_[i]] + 1;
  const float per = 1 / *std::max_element(place, place + segment_count_);
  for (size_t row = 0; row < groups * segment_count_; ++row) {
    float* to = inputs_ + (row * simd::kRodStartInputs + simd::kRodStartNumbers) * width_;
    std::fill_n(to, width_, place[row % segment_count_] * per);
  }
  for (uint32_t group = 0; encodings_ && group < groups; ++group) {
    const simd::RodJob job = group_job(group, 1, scratch_);
    float* joints = scratch_;
    for (uint32_t i = 1; i < segment_count_; ++i) {
      for (uint32_t lane = 0; lane < width_; ++lane) {
        float told[simd::kRodJointInputs];
        tell_joint(group * width_ + lane, i, told);
        for (uint32_t k = 0; k < simd::kRodJointInputs; ++k) {
          joints[(size_t{i} * simd::kRodJointInputs + k) * width_ + lane] = told[k];
        }
      }
    }
    calls(width_).encode_joints(job, net_, joints, encodings_ + group * segment_count_ * net_.latent * width_,
                                planes_);
  }
}

// Of a record's joint.
void RodBatch::tell_joint(uint32_t strand, uint32_t slot,
                          float (&out)[simd::kRodJointInputs]) const noexcept {
  const float* record = records_ +
                        (size_t{group_of(strand)} * segment_count_ + slot) * simd::kRodKeptFields * width_ +
                        lane_of(strand);
  float rest[3];
  for (uint32_t k = 0; k < 3; ++k) rest[k] = record[(simd::kRodRest + k) * width_];
  joint_inputs(rest, record[simd::kRodBendCompliance * width_], record[simd::kRodTwistCompliance * width_],
               out);
}

StartInputs RodBatch::start_inputs(uint32_t strand, uint32_t segment) const noexcept {
  StartInputs out{};
  if (!inputs_) return out;
  const simd::RodStartJob job = start_job(group_of(strand));
  const uint32_t lane = lane_of(strand), slot = slots_[segment];
  const auto read = [&](const float* rows, size_t row, uint32_t count, float* to) {
    for (uint32_t k = 0; k < count; ++k) to[k] = rows[(row * count + k) * width_ + lane];
  };
  read(job.inputs, slot, simd::kRodStartInputs, out.told);
  read(job.continued, slot, simd::kRodStartNumbers, out.continued);
  read(job.scales, 0, simd::kRodStartTriples, out.scales);
  if (slot > 0) tell_joint(strand, slot, out.joint);
  return out;
}

}  // namespace sinew::rods
