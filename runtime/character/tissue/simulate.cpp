// simulate.cpp  One tick of modes, or of modes under a network.
#include "character/tissue/simulate.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "character/parameters/air.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "character/tissue/emulate.hpp"
#include "character/tissue/region_part.hpp"
#include "character/transition/change_level.hpp"
#include "kernels/kernels.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/correction_budget.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"
#include "tissue/network/inputs.hpp"
#include "tissue/network/network.hpp"

namespace sinew::world {
namespace {

size_t floats_of(const Instance& instance) noexcept { return size_t{3} * instance.level->node_count(); }

void scale(float* values, size_t count, float by) noexcept {
  for (size_t i = 0; i < count; ++i) values[i] *= by;
}

void turn_and_warp(Instance& instance, const Part& part) noexcept {
  tissue::modal_turn(part.base, instance.tissue.q[0] + part.mode, instance.tissue.region[0],
                     instance.tissue.theta + part.vector);
  tissue::warp(instance.tissue.theta + part.vector, instance.tissue.l[0] + part.vector,
               part.record.node_count, instance.tissue.u[0] + part.vector);
}

// All that goes on from the tick is scaled, and what that came from, which frames between ticks go on with.
void hold_swing(Instance& instance, const Part& part, float share) noexcept {
  const size_t modes = part.base.modes.size(), floats = size_t{3} * part.record.node_count;
  for (float* values : {instance.tissue.q[0], instance.tissue.q[1], instance.tissue.corrected[0],
                        instance.tissue.corrected[1], instance.tissue.q_hat})
    scale(values + part.mode, modes, share);
  for (float* values : {instance.tissue.r[0], instance.tissue.r[1], instance.tissue.l[0],
                        instance.tissue.l[1], instance.tissue.r_hat})
    scale(values + part.vector, floats, share);
  instance.tissue.swing[part.index] *= share * share;
  turn_and_warp(instance, part);
}

// u of this tick is what may be shown of it, and what goes beyond the limit is counted and held.
void hold_shown(Instance& instance, const Part& part) noexcept {
  const uint32_t nodes = part.record.node_count;
  float* u = instance.tissue.u[0] + part.vector;
  float largest_m = tissue::largest_displacement_m(u, nodes);
  const float held = tissue::swing_share(largest_m, swing_limit_m(part, part.limit_m));
  if (held != 1) {
    hold_swing(instance, part, held);
    largest_m = tissue::largest_displacement_m(u, nodes);
    ++instance.state->tissue.displacement_clamps;
  }
  tissue::show(tissue::limit_share(largest_m, part.limit_m), nodes, u);
}

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

// ---- modes ----

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
void begin_modes_at_rest(Instance& instance, const Part& part, const float* heard, float share) noexcept {
  const tissue::ModalBase& base = part.base;
  float *q[2] = {instance.tissue.q[0] + part.mode, instance.tissue.q[1] + part.mode},
        *r[2] = {instance.tissue.r[0] + part.vector, instance.tissue.r[1] + part.vector},
        *l = instance.tissue.region[1];
  const size_t floats = size_t{3} * part.record.node_count;
  for (size_t m = 0; m < base.modes.size(); ++m) {
    const pack::ModeRecord& mode = base.modes[m];
    q[0][m] = q[1][m] = share * mode.gain * heard[base.padded + m] / (1 - mode.a1 - mode.a2);
  }
  const auto modes = static_cast<uint32_t>(base.modes.size());
  simd::kernels().add_rows(base.shape, modes, base.padded, q[0], l);
  for (size_t i = 0; i < floats; ++i) l[i] += r[0][i] = r[1][i] = share * heard[i];
  for (float* tick : instance.tissue.l) std::copy_n(l, floats, tick + part.vector);
  float *theta = instance.tissue.theta + part.vector, *moved = instance.tissue.carry + part.vector;
  tissue::modal_turn(base, q[0], l, theta);
  tissue::warp(theta, instance.tissue.l[0] + part.vector, part.record.node_count, moved);
  tissue::hold_within(part.limit_m, part.record.node_count, moved);
  for (size_t i = 0; i < floats; ++i) moved[i] -= instance.tissue.u[0][part.vector + i];
  for (float* corrected : instance.tissue.corrected) std::fill_n(corrected + part.mode, modes, 0.0f);
  instance.tissue.swing[part.index] = 0;
}

// Where the tick begins something at rest, carry tells by how much u moved. False: nothing.
bool begin_part(Instance& instance, const Part& part, const float* heard) noexcept {
  const bool begins = begins_at_rest(instance, part);
  if (begins)
    begin_modes_at_rest(instance, part, heard, lasting_share(part, instance.tissue.felt + part.vector, 3));
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

namespace {

// q_hat, r_hat and l_hat; felt is then e. False where they are not finite.
bool base_step(Instance& instance) noexcept {
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

// q += project (l - from).
void project_change(Instance& instance, const Part& part, const float* l, const float* from,
                    float* q) noexcept {
  float* change = instance.tissue.region[0];
  const size_t floats = size_t{3} * part.record.node_count;
  for (size_t i = 0; i < floats; ++i) change[i] = l[part.vector + i] - from[part.vector + i];
  tissue::modal_project(part.base, change, q + part.mode);
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
    turn_and_warp(instance, part);
    hold_shown(instance, part);
  });
}

// ---- the network ----

void assemble(Instance& instance) noexcept {
  const Asset& asset = *instance.asset;
  const size_t stride = tissue::input_stride(asset.network);
  for_each_awake_part(instance, [&](const Part& part) {
    if (is_emulated(part)) return;
    const tissue::NodeSources sources{.region = &part.record,
                                      .nodes = instance.level->pack.nodes.data() + part.node,
                                      .drive = instance.tissue.drive + tissue::kNodeDriveWidth * part.node,
                                      .felt = instance.tissue.felt + part.vector,
                                      .l = instance.tissue.l[0] + part.vector,
                                      .l_before = instance.tissue.l[1] + part.vector,
                                      .l_hat = instance.tissue.l_hat + part.vector,
                                      .theta = instance.tissue.theta + part.vector,
                                      .first_rad_per_s = part.first_rad_per_s,
                                      .tick_s = static_cast<float>(asset.tick_s)};
    const uint32_t clamped =
        tissue::assemble_inputs(asset.network, sources, instance.tissue.inputs + stride * part.node);
    instance.state->tissue.input_clamps += clamped;
    instance.tissue.trust[part.index] = tissue::trust_in(asset.network, sources, clamped);
    tissue::carry_to(asset.network, part.record, instance.level->node_count(),
                     instance.tissue.l_hat + part.vector, instance.tissue.network_memory,
                     instance.tissue.carry + part.vector);
  });
}

void give_up_network(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  state.tier = Tier::kModal;
  state.fallback_ticks = kFallbackTicks;
  state.tissue.forgotten = 1;
  wake_regions(instance);
  ++state.tissue.fallbacks;
  instance.marks.fell_back = true;
}

// A network that begins knows nothing of the motion yet: its corrections rise.
float begun_share(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  if (state.tissue.network_begins == 0) return 1;
  --state.tissue.network_begins;
  return 1 - static_cast<float>(state.tissue.network_begins) / kNetworkBeginTicks;
}

bool is_near(const float* a, const float* b, size_t count, float distance) noexcept {
  float most = 0;
  for (size_t i = 0; i < count; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most <= distance;
}

// Of the region's nodes, over the last three ticks: none turned or moved against the root, which went on as
// it did, by more than rounding.
bool pose_stays(const Instance& instance, const Part& part) noexcept {
  constexpr float kRounding = 1e-5f;  // radians, and of the radius
  const float least_m = kRounding * part.record.radius_m;
  const double(&root)[3][3] = instance.state->motion.tick_root_m;
  for (size_t axis = 0; axis < 3; ++axis)
    if (std::abs(root[0][axis] - 2 * root[1][axis] + root[2][axis]) > static_cast<double>(least_m))
      return false;
  for (size_t n = part.node; n < part.node + part.record.node_count; ++n)
    for (const int older : {1, 2}) {
      const tissue::NodePose &now = instance.motion.poses[0][n], &then = instance.motion.poses[older][n];
      if (!is_near(now.rotation, then.rotation, 9, kRounding) ||
          !is_near(now.place_m, then.place_m, 3, least_m))
        return false;
    }
  return true;
}

// d of this tick from those of the last two, and what the tick corrects.
void count_corrections(Instance& instance, const Part& part, const float* correction) noexcept {
  float *now = instance.tissue.corrected[0] + part.mode, *before = instance.tissue.corrected[1] + part.mode;
  for (size_t m = 0; m < part.base.modes.size(); ++m) {
    const pack::ModeRecord& mode = part.base.modes[m];
    const float goes_on = mode.a1 * now[m] + mode.a2 * before[m];
    before[m] = now[m];
    now[m] = goes_on + correction[m];
  }
}

// The share of a correction that the region's budget allows; the budget becomes this tick's.
float spend_budget(Instance& instance, const Part& part, const float* correction) noexcept {
  float base[pack::kMaxModes];
  const float *d = instance.tissue.corrected[0] + part.mode,
              *d_before = instance.tissue.corrected[1] + part.mode;
  for (size_t m = 0; m < part.base.modes.size(); ++m) {
    const pack::ModeRecord& mode = part.base.modes[m];
    base[m] = instance.tissue.q_hat[part.mode + m] - (mode.a1 * d[m] + mode.a2 * d_before[m]);
  }
  return tissue::bounded_share({.modes = part.base.modes,
                                .base = base,
                                .d = d,
                                .d_before = d_before,
                                .correction = correction,
                                .pose_stays = pose_stays(instance, part)},
                               instance.tissue.swing + part.index);
}

// The network's correction as modes have it, as much of it as its budget allows.
void correct_modes(Instance& instance, const Part& part, float most) noexcept {
  alignas(64) float correction[pack::kMaxModes] = {};
  const size_t modes = part.base.modes.size();
  float* change = instance.tissue.region[0];
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    change[i] = most * (instance.tissue.l[0][part.vector + i] - instance.tissue.l_hat[part.vector + i]);
  tissue::modal_project(part.base, change, correction);
  // The budget's proof wants modes that swing; the baker makes no others.
  for (size_t m = 0; m < modes; ++m) {
    const pack::ModeRecord& mode = part.base.modes[m];
    if (mode.a1 * mode.a1 + 4 * mode.a2 >= 0) correction[m] = 0;
  }
  const float share = spend_budget(instance, part, correction);
  // A correction that is not finite takes no share, and 0 times it is none either.
  for (size_t m = 0; m < modes; ++m) correction[m] = share > 0 ? share * correction[m] : 0;
  simd::kernels().add_rows(part.base.shape, static_cast<uint32_t>(modes), part.base.padded, correction,
                           instance.tissue.region[1]);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    instance.tissue.l[0][part.vector + i] =
        instance.tissue.l_hat[part.vector + i] + instance.tissue.region[1][i];
  for (size_t m = 0; m < modes; ++m) instance.tissue.q[0][part.mode + m] += correction[m];
  count_corrections(instance, part, correction);
}

// What a network corrected before goes on with the modes; the budget follows.
void settle_part_on_base(Instance& instance, const Part& part) noexcept {
  const float none[pack::kMaxModes] = {};
  std::copy_n(instance.tissue.l_hat + part.vector, size_t{3} * part.record.node_count,
              instance.tissue.l[0] + part.vector);
  spend_budget(instance, part, none);
  count_corrections(instance, part, none);
}

// l of this tick is the network's, as far as modes can have it and its budget lets it.
void settle_on_network(Instance& instance) noexcept {
  const float all_begun = begun_share(instance);
  // What sleeps keeps its l, of which the network remembers only what is shown.
  for_each_awake_part(instance, [&](const Part& part) {
    const float begun = all_begun * network_share(instance, part.index);
    if (is_emulated(part)) {
      std::copy_n(instance.tissue.emulator.l + part.vector, size_t{3} * part.record.node_count,
                  instance.tissue.l[0] + part.vector);
      return correct_modes(instance, part, begun);
    }
    if (instance.asset->network.layers.empty()) return settle_part_on_base(instance, part);
    tissue::read_output(instance.asset->network, instance.level->pack.regions.subspan(part.index, 1),
                        instance.level->node_count(), instance.tissue.network_memory,
                        instance.tissue.l[0] + part.vector);
    correct_modes(instance, part, begun * instance.tissue.trust[part.index]);
  });
}

// The network goes on from what was taken of its answer.
void take_back_to_network(Instance& instance) noexcept {
  for_each_awake_part(instance, [&](const Part& part) {
    tissue::write_output(instance.asset->network, instance.level->pack.regions.subspan(part.index, 1),
                         instance.level->node_count(), instance.tissue.l[0] + part.vector,
                         instance.tissue.network_memory);
  });
}

void settle_on_base(Instance& instance) noexcept {
  std::copy_n(instance.tissue.l_hat, floats_of(instance), instance.tissue.l[0]);
  if (instance.asset->best() != Tier::kNetwork) return;
  for_each_awake_part(instance, [&](const Part& part) { settle_part_on_base(instance, part); });
}

// Runs of awake regions that are its.
std::span<const tissue::NodeRun> awake_nodes(Instance& instance) noexcept {
  size_t count = 0;
  for_each_awake_part(instance, [&](const Part& part) {
    if (is_emulated(part)) return;
    const auto first = static_cast<uint32_t>(part.node), last = first + part.record.node_count;
    if (count > 0 && instance.tissue.awake[count - 1].last == first)
      instance.tissue.awake[count - 1].last = last;
    else
      instance.tissue.awake[count++] = {first, last};
  });
  return {instance.tissue.awake, count};
}

// True when the network's state is sound after its step.
bool network_step(Instance& instance) noexcept {
  const tissue::Network& network = instance.asset->network;
  bool sound = !instance.asset->emulates() || emulate(instance);
  if (!network.layers.empty()) {
    assemble(instance);
    tissue::network_step(network, instance.level->graph, awake_nodes(instance), instance.tissue.inputs,
                         instance.tissue.carry, instance.tissue.network_memory,
                         instance.tissue.network_scratch);
    sound = sound &&
            tissue::network_is_finite(network, instance.level->node_count(), instance.tissue.network_memory);
  }
  if (!sound) give_up_network(instance);
  return sound;
}

// Of each joint, by its volume; whether one is not as it was bound.
bool size_joints(const Instance& instance) noexcept {
  constexpr float kAsBound = 1e-3f, kLeast = 1e-3f, kMost = 1e3f;
  bool other = false;
  for (uint32_t j = 0; j < instance.level->pack.character->joint_count; ++j) {
    const float* m = instance.motion.skin + size_t{12} * j;
    const float volume = std::abs(m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                                  m[2] * (m[4] * m[9] - m[5] * m[8]));
    const bool as_bound = std::abs(volume - 1) < kAsBound;
    instance.motion.joint_size[j] = as_bound ? 1 : std::clamp(std::cbrt(volume), kLeast, kMost);
    other |= !as_bound;
  }
  return other;
}

}  // namespace

// As skinning blends the joints.
const float* size_nodes(const Instance& instance) noexcept {
  if (!size_joints(instance)) return nullptr;
  for (size_t n = 0; n < instance.level->node_count(); ++n) {
    const pack::SkinRecord& skin = instance.level->pack.nodes[n].skin;
    float size = 0;
    for (uint32_t k = 0; k < pack::kInfluences; ++k)
      size += skin.weight[k] * instance.motion.joint_size[skin.joint[k]];
    instance.motion.node_size[n] = size;
  }
  return instance.motion.node_size;
}

void drive_nodes(Instance& instance) noexcept {
  tissue::NodeMotion motion;
  motion.size = size_nodes(instance);
  instance.motion.scaled_nodes = motion.size != nullptr;
  motion.most_m_s2 = instance.parameters.most_m_s2;
  for (int tick = 0; tick < 3; ++tick) {
    motion.pose[tick] = instance.motion.poses[tick];
    std::copy_n(instance.state->motion.tick_root_m[tick], 3, motion.root_position_m[tick]);
  }
  tissue::compute_node_drive(motion, static_cast<float>(instance.asset->tick_s), instance.level->node_count(),
                             instance.tissue.drive);
  if (tunes_air(instance)) add_air(instance);
}

bool simulate_tick(Instance& instance) noexcept {
  if (!base_step(instance)) return false;
  const bool corrected = instance.state->tier == Tier::kNetwork && network_step(instance);
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

namespace {

// r of a tick: what of l the modes cannot hold.
void leave_to_rest(Instance& instance, const Part& part, int tick) noexcept {
  float* held = instance.tissue.region[0];
  simd::kernels().add_rows(part.base.shape, static_cast<uint32_t>(part.base.modes.size()), part.base.padded,
                           instance.tissue.q[tick] + part.mode, held);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    instance.tissue.r[tick][part.vector + i] = instance.tissue.l[tick][part.vector + i] - held[i];
}

// Not all of it: what a network knew is nearer to the truth. As much as perf/jumps.sh wants.
void answer_of_modes(Instance& instance, const Part& part, int tick) noexcept {
  float *q = instance.tissue.q[tick] + part.mode, *l = instance.tissue.l[tick] + part.vector,
        *held = instance.tissue.region[1];
  const auto modes = static_cast<uint32_t>(part.base.modes.size());
  constexpr float kTakenBack = 0.6f;
  for (uint32_t m = 0; m < modes; ++m)
    q[m] -= kTakenBack * std::exchange(instance.tissue.corrected[tick][part.mode + m], 0.0f);
  simd::kernels().add_rows(part.base.shape, modes, part.base.padded, q, held);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    l[i] = held[i] + instance.tissue.r[tick][part.vector + i];
  tissue::modal_turn(part.base, q, held, instance.tissue.theta + part.vector);
  tissue::warp(instance.tissue.theta + part.vector, l, part.record.node_count,
               instance.tissue.u[tick] + part.vector);
  tissue::hold_within(part.limit_m, part.record.node_count, instance.tissue.u[tick] + part.vector);
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
    for_each_part(instance, [&](const Part& part) { answer_of_modes(instance, part, tick); });
}

void lift_displacement(Instance& instance) noexcept {
  for (int tick = 0; tick < 2; ++tick) {
    std::fill_n(instance.tissue.r[tick], floats_of(instance), 0.0f);
    std::fill_n(instance.tissue.q[tick], instance.level->mode_count(), 0.0f);
    std::fill_n(instance.tissue.corrected[tick], instance.level->mode_count(), 0.0f);
  }
  std::fill_n(instance.tissue.swing, instance.level->pack.regions.size(), 0.0f);
  for_each_part(instance, [&](const Part& part) {
    for (int tick = 0; tick < 2; ++tick) {
      project_change(instance, part, instance.tissue.l[tick], instance.tissue.r[tick],
                     instance.tissue.q[tick]);  // r is zero
      leave_to_rest(instance, part, tick);
    }
    tissue::modal_turn(part.base, instance.tissue.q[0] + part.mode, instance.tissue.region[0],
                       instance.tissue.theta + part.vector);
  });
}

}  // namespace sinew::world
