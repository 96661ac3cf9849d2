// step_between.cpp  Rods between two steps of a time h, by a fraction x of it.
//
// In the place of an implicit Euler step of x h from the last step's state,
//   d = x h v + x h force_s (accelerations at d),   force_s = h (1 + x) / 2
// is solved: at x = 1 the step itself, and the velocity is the same where one step ends and the next begins,
// as far as accelerations do not change within a step. x h of forces would leave the change of a whole step's
// velocity to the moment of the step.
#include <algorithm>
#include <cmath>

#include "core/floating_point.hpp"
#include "core/status.hpp"
#include "kernels/kernels.hpp"
#include "rods/contacts/collider.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {

void RodBatch::read_turns(uint32_t group, const simd::RodJob& job, float* turns_xyzw) const noexcept {
  const uint32_t first = group * width_, count = std::min(width_, strand_count_ - first);
  for (uint32_t lane = 0; lane < count; ++lane) {
    float* to = turns_xyzw + size_t{4} * (first + lane) * segment_count_;
    float sum = 0;
    for (uint32_t i = 0; i < segment_count_; ++i)
      for (uint32_t k = 0; k < 4; ++k) {
        const size_t row =
            size_t{slots_[i]} * simd::kRodScratchRows + simd::kRodNow - simd::kRodKeptFields + k;
        sum += to[4 * i + k] = job.scratch[row * width_ + lane];
      }
    if (std::isfinite(sum)) continue;
    for (uint32_t i = 0; i < segment_count_; ++i)
      for (uint32_t k = 0; k < 4; ++k) to[4 * i + k] = at(first + lane, i, simd::kRodTurn + k);
  }
}

Status RodBatch::step_between(float dt_s, float fraction, const RodCollider* touched,
                              float* turns_xyzw) const noexcept {
  if (!(dt_s > 0 && dt_s <= 1) || !(fraction > 0 && fraction <= 1))
    return core::make_status(StatusCode::kInvalidArgument,
                             "a fraction %g of %g s; give numbers above 0, at most 1",
                             static_cast<double>(fraction), static_cast<double>(dt_s));
  const core::FloatingPointScope mode;
  const simd::RodKernels& kernels = *simd::kernels().rods;
  const simd::RodCalls& calls = width_ == 16 ? kernels.wide : kernels.narrow;
  for (uint32_t group = 0; group < group_count(); ++group) {
    simd::RodJob job = group_job(group, fraction * dt_s, scratch_);
    job.force_s = dt_s * (1 + fraction) / 2;
    activate(group, job);
    calls.predict(job);
    if (touched && touched->has_forces()) calls.hold_forces(job);
    for (uint32_t left = settings_.max_iterations; left > 0 && calls.direct(job) > 0; --left) continue;
    read_turns(group, job, turns_xyzw);
  }
  return {};
}

}  // namespace sinew::rods
