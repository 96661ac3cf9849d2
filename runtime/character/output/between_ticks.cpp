// between_ticks.cpp  see between_ticks.hpp.
#include "character/output/between_ticks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "character/motion/motion.hpp"
#include "character/parameters/air.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "character/rest/sleep.hpp"
#include "character/tissue/drive_nodes.hpp"
#include "character/tissue/region_part.hpp"
#include "character/tissue/step_base.hpp"
#include "character/transition/blend.hpp"
#include "character/transition/shares.hpp"
#include "character/transition/simulated_shown.hpp"
#include "tissue/frames/fraction_step.hpp"
#include "tissue/frames/node_bend.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/guard.hpp"

namespace sinew::world {
namespace {

size_t floats_of(const Instance& instance) noexcept { return size_t{3} * instance.level->node_count(); }

// The present pose and those of the last two ticks, of all nodes.
tissue::NodeMotion motion_now(Instance& instance) noexcept {
  pose_now(instance, instance.motion.poses_now);
  tissue::NodeMotion motion;
  motion.size = size_nodes(instance);
  motion.most_m_s2 = instance.parameters.most_m_s2;
  motion.pose[0] = instance.motion.poses_now;
  std::copy_n(instance.state->motion.root.position_m, 3, motion.root_position_m[0]);
  for (int tick = 0; tick < 2; ++tick) {
    motion.pose[tick + 1] = instance.motion.poses[tick];
    std::copy_n(instance.state->motion.tick_root_m[tick], 3, motion.root_position_m[tick + 1]);
  }
  return motion;
}

// Of a region that sleeps: it feels nothing yet that would wake it in the coming tick.
bool sleeps_on(const Instance& instance, const Part& part, float x) noexcept {
  return is_asleep(instance, part.index) &&
         feels_as_asleep(instance, part.index, {instance.tissue.felt + part.vector, 3, 2 / (x * (1 + x))});
}

// f of a part's nodes.
void feel(Instance& instance, const tissue::NodeMotion& motion, const Part& part, float x) noexcept {
  const auto tick_s = static_cast<float>(instance.asset->tick_s);
  tissue::NodeMotion of_part = motion;
  for (auto& pose : of_part.pose) pose += part.node;
  if (of_part.size) of_part.size += part.node;
  tissue::fraction_felt(of_part, tick_s, x, part.record.node_count, instance.tissue.felt + part.vector);
  if (tunes_air(instance))
    add_air_between(instance, part.index, {of_part.pose[0], of_part.pose[1]}, x,
                    instance.tissue.felt + part.vector);
}

// phi on top of it.
void feel_turning(Instance& instance, const tissue::NodeMotion& motion, const Part& part, float x) noexcept {
  const tissue::NodePose* const poses[3] = {motion.pose[0] + part.node, motion.pose[1] + part.node,
                                            motion.pose[2] + part.node};
  float *felt = instance.tissue.felt + part.vector, *phi = instance.tissue.region[0];
  tissue::frame_term(poses, instance.tissue.u[0] + part.vector, instance.tissue.u[1] + part.vector,
                     static_cast<float>(instance.asset->tick_s), part.record.node_count, phi, x);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i) felt[i] += phi[i];
}

// What a part hears at the fraction: nothing on the tick itself.
void hear(Instance& instance, const Part& part, float x, float* heard) noexcept {
  if (x == 0) return void(std::fill_n(heard, part.base.padded + part.base.padded_modes, 0.0f));
  float* felt = instance.tissue.felt + part.vector;
  tissue::modal_hear(part.base, felt, theta_of_base(instance, part), felt, heard);
}

// u of a part at the fraction, into `out`.
void step_part(Instance& instance, const Part& part, float x, float* out) noexcept {
  float *heard = instance.tissue.region[0], *l = instance.tissue.region[1];
  hear(instance, part, x, heard);
  const tissue::ModalState state{.q = instance.tissue.q[0] + part.mode,
                                 .q_before = instance.tissue.q[1] + part.mode,
                                 .r = instance.tissue.r[0] + part.vector,
                                 .r_before = instance.tissue.r[1] + part.vector};
  float *q = instance.tissue.q_hat + part.mode, *theta = instance.tissue.r_hat + part.vector;
  tissue::fraction_answer(part.base, slopes_of(instance, part.index), heard, state, force_of(instance, part),
                          x, {.q = q, .r = instance.tissue.r_hat + part.vector, .l = l});
  const float most_m = limit_m(instance, part.index, x);
  tissue::modal_turn(part.base, q, instance.tissue.region[0], theta);
  tissue::warp(theta, l, part.record.node_count, out);
  // As the tick will hold it, by so much of it.
  float largest_m = tissue::largest_displacement_m(out, part.record.node_count);
  const float held = tissue::swing_share(largest_m, swing_limit_m(part, most_m));
  if (held != 1) {
    const float share = std::pow(held, x);
    for (size_t m = 0; m < part.base.modes.size(); ++m) q[m] *= share;
    for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i) l[i] *= share;
    tissue::modal_turn(part.base, q, instance.tissue.region[0], theta);
    tissue::warp(theta, l, part.record.node_count, out);
    largest_m = tissue::largest_displacement_m(out, part.record.node_count);
  }
  tissue::show(tissue::limit_share(largest_m, most_m), part.record.node_count, out);
  if (!tissue::all_finite(out, size_t{3} * part.record.node_count))
    std::copy_n(instance.tissue.u[0] + part.vector, size_t{3} * part.record.node_count, out);
}

// Of a part that teleported: its past is another pose's until the next tick, and it goes on as it went.
void go_on(const Instance& instance, const Part& part, float x, float* out) noexcept {
  const float *now = instance.tissue.u[0] + part.vector, *before = instance.tissue.u[1] + part.vector;
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i) out[i] = now[i] + x * (now[i] - before[i]);
  tissue::hold_within(limit_m(instance, part.index, x), part.record.node_count, out);
}

void step_soft_parts(Instance& instance, float x, float* out) noexcept {
  std::copy_n(instance.tissue.u[0], floats_of(instance), out);
  const tissue::NodeMotion motion = motion_now(instance);
  for_each_part(instance, [&](const Part& part) {
    if (instance.level->leaves_out(part.index) || region_is_off(instance, part.index)) return;
    if (instance.motion.carried_regions[part.index]) return go_on(instance, part, x, out + part.vector);
    if (x > 0) {
      feel(instance, motion, part, x);
      if (sleeps_on(instance, part, x)) return;
      feel_turning(instance, motion, part, x);
    }
    step_part(instance, part, x, out + part.vector);
  });
  tissue::along_flesh(instance.motion.poses_now, out, instance.level->node_count(), out);
  keep_regained_share(instance, out, x);
  keep_intensity(instance, out, x);
}

// Where no tick has followed the motion yet.
const float* go_on_as_shown(const Instance& instance, float x, float* out) noexcept {
  for (size_t i = 0; i < floats_of(instance); ++i)
    out[i] = instance.transition.shown[0][i] +
             x * (instance.transition.shown[0][i] - instance.transition.shown[1][i]);
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    tissue::hold_within(shown_limit_m(instance, r), region.node_count, out + size_t{3} * region.first_node);
  }
  return out;
}

bool all_sleep_still(const Instance& instance) noexcept {
  return instance.state->poses.still_ticks > 0 &&
         regions_asleep(instance) + instance.level->regions_left_out() == instance.level->pack.regions.size();
}

}  // namespace

void hold_added(Instance& instance, bool goes_on) noexcept {
  constexpr double kShort = 0.2;  // of a tick
  const bool shows_fractions = goes_on && instance.plan.dt_s < kShort * instance.asset->tick_s;
  const float share = shows_fractions ? 1 : 0;
  const tissue::TickForce& tick = instance.tissue.tick_force;
  float most = 0;
  const auto hold = [&](const float* now, const float* base, float* added, float* off, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      const float before = std::exchange(added[i], now[i] - base[i]);
      off[i] = share * (before - added[i]);
      most = std::max(most, std::abs(off[i]));
    }
  };
  std::fill_n(tick.off_q, instance.level->mode_count(), 0.0f);
  std::fill_n(tick.off_r, floats_of(instance), 0.0f);
  for_each_awake_part(instance, [&](const Part& part) {
    const tissue::TickForce of = force_of(instance, part);
    const size_t m = part.mode, v = part.vector;
    hold(instance.tissue.q[0] + m, instance.tissue.q_hat + m, of.added_q, of.off_q, part.base.modes.size());
    hold(instance.tissue.r[0] + v, instance.tissue.r_hat + v, of.added_r, of.off_r,
         size_t{3} * part.record.node_count);
  });
  instance.state->tissue.is_off = most > 0;
}

const float* shown_now(Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const float x = state.poses.render_fraction;
  if (shown_share(instance) == 0) return instance.transition.shown[0];
  float* out = instance.published.shown_between;
  if (!frame::is_simulated(state.tier)) {
    if (x == 0) return instance.transition.tail;
    tail_between(instance, x, out);
    return out;
  }
  if ((x == 0 && !state.tissue.is_off) || all_sleep_still(instance)) return instance.transition.shown[0];
  if (state.poses.motion_stale) return go_on_as_shown(instance, x, out);
  step_soft_parts(instance, x, out);
  const auto [share, tail_share] = shown_shares(instance, x);
  if (share == 1 && tail_share == 0) return out;
  float* tail = instance.tissue.felt;
  if (state.transition.tail_rides)
    std::copy_n(instance.transition.tail, floats_of(instance), tail);
  else
    tail_between(instance, x, tail);
  for (size_t i = 0; i < floats_of(instance); ++i) out[i] = share * out[i] + tail_share * tail[i];
  return out;
}

}  // namespace sinew::world
