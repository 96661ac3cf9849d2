// simulate.cpp  One tick of modes, or of modes under a network.
#include "character/tissue/simulate.hpp"

#include <algorithm>

#include "character/tissue/region_part.hpp"
#include "character/tissue/spend_corrections.hpp"
#include "character/tissue/step_base.hpp"
#include "character/tissue/step_network.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"

namespace sinew::world {
namespace {

size_t floats_of(const Instance& instance) noexcept { return size_t{3} * instance.level->node_count(); }

void scale(float* values, size_t count, float by) noexcept {
  for (size_t i = 0; i < count; ++i) values[i] *= by;
}

void turn_and_warp(TissueState& tissue, const Part& part) noexcept {
  tissue::modal_turn(part.base, tissue.q[0] + part.mode, tissue.region[0], tissue.theta + part.vector);
  tissue::warp(tissue.theta + part.vector, tissue.l[0] + part.vector, part.record.node_count,
               tissue.u[0] + part.vector);
}

// All that goes on from the tick is scaled, and what that came from, which frames between ticks go on with.
void hold_swing(TissueState& tissue, const Part& part, float share) noexcept {
  const size_t modes = part.base.modes.size(), floats = size_t{3} * part.record.node_count;
  for (float* values : {tissue.q[0], tissue.q[1], tissue.corrected[0], tissue.corrected[1], tissue.q_hat})
    scale(values + part.mode, modes, share);
  for (float* values : {tissue.r[0], tissue.r[1], tissue.l[0], tissue.l[1], tissue.r_hat})
    scale(values + part.vector, floats, share);
  tissue.swing[part.index] *= share * share;
  turn_and_warp(tissue, part);
}

// u of this tick is what may be shown of it, and what goes beyond the limit is counted and held.
void hold_shown(Instance& instance, const Part& part) noexcept {
  const uint32_t nodes = part.record.node_count;
  float* u = instance.tissue.u[0] + part.vector;
  float largest_m = tissue::largest_displacement_m(u, nodes);
  const float held = tissue::swing_share(largest_m, swing_limit_m(part, part.limit_m));
  if (held != 1) {
    hold_swing(instance.tissue, part, held);
    largest_m = tissue::largest_displacement_m(u, nodes);
    ++instance.state->tissue.displacement_clamps;
  }
  tissue::show(tissue::limit_share(largest_m, part.limit_m), nodes, u);
}

void shift_back(Instance& instance) noexcept {
  const size_t floats = floats_of(instance);
  std::copy_n(instance.tissue.u[0], floats, instance.tissue.u[1]);
  std::copy_n(instance.tissue.l[0], floats, instance.tissue.l[1]);
  std::copy_n(instance.tissue.r[0], floats, instance.tissue.r[1]);
  std::copy_n(instance.tissue.q[0], instance.level->mode_count(), instance.tissue.q[1]);
}

// q and r of this tick are the base's.
void take_base_answer(Instance& instance) noexcept {
  std::copy_n(instance.tissue.r_hat, floats_of(instance), instance.tissue.r[0]);
  std::copy_n(instance.tissue.q_hat, instance.level->mode_count(), instance.tissue.q[0]);
}

// theta and u follow from q and l.
void settle(Instance& instance) noexcept {
  for_each_awake_part(instance, [&](const Part& part) {
    turn_and_warp(instance.tissue, part);
    hold_shown(instance, part);
  });
}

}  // namespace

bool simulate_tick(Instance& instance) noexcept {
  if (!step_base(instance)) return false;
  const bool corrected = instance.state->tier == Tier::kNetwork && step_network(instance);
  shift_back(instance);
  take_base_answer(instance);
  if (corrected)
    settle_on_network(instance);
  else
    settle_on_base(instance);
  settle(instance);
  if (corrected) take_back_to_network(instance);
  return true;
}

}  // namespace sinew::world
