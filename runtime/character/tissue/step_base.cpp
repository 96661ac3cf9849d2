// step_base.cpp  see step_base.hpp.
#include "character/tissue/step_base.hpp"

#include <algorithm>
#include <cmath>

#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "character/tissue/region_part.hpp"
#include "character/transition/change_level.hpp"
#include "kernels/kernels.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"

namespace sinew::world {
namespace {

size_t floats_of(const Instance& instance) noexcept { return size_t{3} * instance.level->node_count(); }

// In this tick, and next to nothing of it is seen yet: a change of level had the region again, or all of the
// instance comes back after more than it makes up for.
bool begins_at_rest(const Instance& instance, const Part& part) noexcept {
  return instance.state->transition.rest_ticks > 0 ||
         instance.transition.regained[part.index] == kRegainedNow;
}

// What of a load counts as lasting: the answer to a jolt that lasted for ever would be far off.
float lasting_share(const Part& part, const float* felt, size_t stride) noexcept {
  constexpr float kMost_m_s2 = 20;  // gravity upside down
  float most = 0;
  for (size_t n = 0; n < part.record.node_count; ++n, felt += stride)
    most = std::max(most, std::hypot(felt[0], felt[1], felt[2]));
  return most > kMost_m_s2 ? kMost_m_s2 / most : 1.0f;
}

void frame_term(Instance& instance, const Part& part) noexcept {
  const tissue::NodePose* const poses[3] = {instance.motion.poses[0] + part.node,
                                            instance.motion.poses[1] + part.node,
                                            instance.motion.poses[2] + part.node};
  tissue::frame_term(poses, instance.tissue.u[0] + part.vector, instance.tissue.u[1] + part.vector,
                     static_cast<float>(instance.asset->tick_s), part.record.node_count,
                     instance.tissue.felt + part.vector);
}

// f + phi.
void feel(Instance& instance, const Part& part) noexcept {
  frame_term(instance, part);
  for (size_t n = part.node; n < part.node + part.record.node_count; ++n) {
    for (size_t k = 0; k < 3; ++k)
      instance.tissue.felt[3 * n + k] += instance.tissue.drive[tissue::kNodeDriveWidth * n + k];
  }
}

// What sleeps answers with what it is.
void answer_as_before(Instance& instance) noexcept {
  std::copy_n(instance.tissue.q[0], instance.level->mode_count(), instance.tissue.q_hat);
  std::copy_n(instance.tissue.r[0], floats_of(instance), instance.tissue.r_hat);
  std::copy_n(instance.tissue.l[0], floats_of(instance), instance.tissue.l_hat);
  std::fill_n(instance.tissue.carry, floats_of(instance),
              0.0f);  // nothing of it moves where others begin at rest
}

// As so much of what it hears would hold it for ever, in q, r and l; carry is what is then shown, less u.
void begin_modes_at_rest(TissueState& tissue, const Part& part, const float* heard, float share) noexcept {
  const tissue::ModalBase& base = part.base;
  float *q[2] = {tissue.q[0] + part.mode, tissue.q[1] + part.mode},
        *r[2] = {tissue.r[0] + part.vector, tissue.r[1] + part.vector}, *l = tissue.region[1];
  const size_t floats = size_t{3} * part.record.node_count;
  for (size_t m = 0; m < base.modes.size(); ++m) {
    const pack::ModeRecord& mode = base.modes[m];
    q[0][m] = q[1][m] = share * mode.gain * heard[base.padded + m] / (1 - mode.a1 - mode.a2);
  }
  const auto modes = static_cast<uint32_t>(base.modes.size());
  simd::kernels().add_rows(base.shape, modes, base.padded, q[0], l);
  for (size_t i = 0; i < floats; ++i) l[i] += r[0][i] = r[1][i] = share * heard[i];
  for (float* tick : tissue.l) std::copy_n(l, floats, tick + part.vector);
  float *theta = tissue.theta + part.vector, *moved = tissue.carry + part.vector;
  tissue::modal_turn(base, q[0], l, theta);
  tissue::warp(theta, tissue.l[0] + part.vector, part.record.node_count, moved);
  tissue::hold_within(part.limit_m, part.record.node_count, moved);
  for (size_t i = 0; i < floats; ++i) moved[i] -= tissue.u[0][part.vector + i];
  for (float* corrected : tissue.corrected) std::fill_n(corrected + part.mode, modes, 0.0f);
  tissue.swing[part.index] = 0;
}

// Where the tick begins something at rest, carry tells by how much u moved. False: nothing.
bool begin_part(Instance& instance, const Part& part, const float* heard) noexcept {
  const bool begins = begins_at_rest(instance, part);
  if (begins)
    begin_modes_at_rest(instance.tissue, part, heard,
                        lasting_share(part, instance.tissue.felt + part.vector, 3));
  else
    std::fill_n(instance.tissue.carry + part.vector, 3 * part.record.node_count, 0.0f);
  return begins;
}

}  // namespace

const float* theta_of_base(Instance& instance, const Part& part) noexcept {
  if (instance.state->tier != Tier::kNetwork) return instance.tissue.theta + part.vector;
  alignas(64) float base[pack::kMaxModes];
  for (size_t m = 0; m < part.base.modes.size(); ++m)
    base[m] = instance.tissue.q[0][part.mode + m] - instance.tissue.corrected[0][part.mode + m];
  float* theta = instance.tissue.carry + part.vector;
  tissue::modal_turn(part.base, base, instance.tissue.region[0], theta);
  return theta;
}

bool step_base(Instance& instance) noexcept {
  if (regions_asleep(instance) + instance.level->regions_left_out() > 0) answer_as_before(instance);
  bool moved = false;
  for_each_awake_part(instance, [&](const Part& part) {
    feel(instance, part);
    float *felt = instance.tissue.felt + part.vector, *heard = instance.tissue.region[0];
    tissue::modal_hear(part.base, felt, theta_of_base(instance, part), felt, heard);
    moved |= begin_part(instance, part, heard);
    tissue::take_force(part.base, heard, force_of(instance, part));
    const tissue::ModalState state{.q = instance.tissue.q[0] + part.mode,
                                   .q_before = instance.tissue.q[1] + part.mode,
                                   .r = instance.tissue.r[0] + part.vector,
                                   .r_before = instance.tissue.r[1] + part.vector};
    tissue::modal_answer(part.base, heard, state,
                         {.q = instance.tissue.q_hat + part.mode,
                          .r = instance.tissue.r_hat + part.vector,
                          .l = instance.tissue.region[1]});
    std::copy_n(instance.tissue.region[1], 3 * part.record.node_count, instance.tissue.l_hat + part.vector);
  });
  if (moved) settle_rest(instance, instance.tissue.carry);
  return tissue::all_finite(instance.tissue.l_hat, floats_of(instance)) &&
         tissue::all_finite(instance.tissue.q_hat, instance.level->mode_count());
}

}  // namespace sinew::world
