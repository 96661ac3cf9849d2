// hand_over.cpp  see hand_over.hpp.
#include "character/tissue/hand_over.hpp"

#include <algorithm>
#include <utility>

#include "character/tissue/region_part.hpp"
#include "kernels/kernels.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"

namespace sinew::world {
namespace {

// q += project (l - from).
void project_change(TissueState& tissue, const Part& part, const float* l, const float* from,
                    float* q) noexcept {
  float* change = tissue.region[0];
  const size_t floats = size_t{3} * part.record.node_count;
  for (size_t i = 0; i < floats; ++i) change[i] = l[part.vector + i] - from[part.vector + i];
  tissue::modal_project(part.base, change, q + part.mode);
}

// r of a tick: what of l the modes cannot hold.
void leave_to_rest(TissueState& tissue, const Part& part, int tick) noexcept {
  float* held = tissue.region[0];
  simd::kernels().add_rows(part.base.shape, static_cast<uint32_t>(part.base.modes.size()), part.base.padded,
                           tissue.q[tick] + part.mode, held);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    tissue.r[tick][part.vector + i] = tissue.l[tick][part.vector + i] - held[i];
}

// Not all of it: what a network knew is nearer to the truth. As much as perf/jumps.sh wants.
void answer_of_modes(TissueState& tissue, const Part& part, int tick) noexcept {
  float *q = tissue.q[tick] + part.mode, *l = tissue.l[tick] + part.vector, *held = tissue.region[1];
  const auto modes = static_cast<uint32_t>(part.base.modes.size());
  constexpr float kTakenBack = 0.6f;
  for (uint32_t m = 0; m < modes; ++m)
    q[m] -= kTakenBack * std::exchange(tissue.corrected[tick][part.mode + m], 0.0f);
  simd::kernels().add_rows(part.base.shape, modes, part.base.padded, q, held);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    l[i] = held[i] + tissue.r[tick][part.vector + i];
  tissue::modal_turn(part.base, q, held, tissue.theta + part.vector);
  tissue::warp(tissue.theta + part.vector, l, part.record.node_count, tissue.u[tick] + part.vector);
  tissue::hold_within(part.limit_m, part.record.node_count, tissue.u[tick] + part.vector);
}

}  // namespace

// As much as perf/jumps.sh wants.
void slow_modes(Instance& instance) noexcept {
  constexpr float kSlower = 0.05f;
  const float* now = instance.tissue.q[0];
  float* before = instance.tissue.q[1];
  for (size_t m = 0; m < instance.level->mode_count(); ++m) before[m] += kSlower * (now[m] - before[m]);
}

void take_back_corrections(Instance& instance) noexcept {
  for (const int tick : {1, 0})  // theta is the newer tick's
    for_each_part(instance, [&](const Part& part) { answer_of_modes(instance.tissue, part, tick); });
}

void lift_displacement(Instance& instance) noexcept {
  for (int tick = 0; tick < 2; ++tick) {
    std::fill_n(instance.tissue.r[tick], size_t{3} * instance.level->node_count(), 0.0f);
    std::fill_n(instance.tissue.q[tick], instance.level->mode_count(), 0.0f);
    std::fill_n(instance.tissue.corrected[tick], instance.level->mode_count(), 0.0f);
  }
  std::fill_n(instance.tissue.swing, instance.level->pack.regions.size(), 0.0f);
  for_each_part(instance, [&](const Part& part) {
    for (int tick = 0; tick < 2; ++tick) {
      project_change(instance.tissue, part, instance.tissue.l[tick], instance.tissue.r[tick],
                     instance.tissue.q[tick]);  // r is zero
      leave_to_rest(instance.tissue, part, tick);
    }
    tissue::modal_turn(part.base, instance.tissue.q[0] + part.mode, instance.tissue.region[0],
                       instance.tissue.theta + part.vector);
  });
}

}  // namespace sinew::world
