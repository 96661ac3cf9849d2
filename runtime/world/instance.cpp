// instance.cpp  One character in the world: memory and life cycle.
#include "world/instance.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "core/clock.hpp"
#include "core/status.hpp"
#include "frame/scheduler.hpp"
#include "tissue/inputs.hpp"
#include "tissue/network.hpp"
#include "tissue/node_drive.hpp"
#include "world/change_level.hpp"
#include "world/dormant.hpp"
#include "world/pose_bound.hpp"
#include "world/publish.hpp"
#include "world/push_surface.hpp"
#include "world/rod_batches.hpp"
#include "world/rod_blend.hpp"
#include "world/rod_contacts.hpp"
#include "world/rod_sleep.hpp"
#include "world/sleep.hpp"
#include "world/teleport.hpp"
#include "world/tuning.hpp"

namespace sinew::world {
namespace {

static_assert(std::is_trivially_copyable_v<InstanceState>, "saved as bytes");
static_assert(sizeof(InstanceState) == 872, "no padding: equal states are equal bytes");
static_assert(offsetof(InstanceState, root) == kPlannedStateBytes, "what is planned by comes first");

float smooth_step(float t) noexcept { return t * t * (3 - 2 * t); }

// Its first three derivatives are zero at both ends.
float gentle_step(float t) noexcept { return t * t * t * t * (35 - t * (84 - t * (70 - 20 * t))); }

bool touches_own_body(const Asset& asset, const ContactDef& contacts) noexcept {
  return contacts.own_body && asset.touchable != nullptr;
}

bool soft_parts_touch(const Asset& asset, const ContactDef& contacts) noexcept {
  return contacts.source || touches_own_body(asset, contacts);
}

void lay_out_state(const Asset& asset, core::Arena& arena, Instance& to) noexcept {
  const uint32_t joints = asset.pack.character->joint_count;
  const size_t vectors = size_t{3} * asset.node_count();
  to.state = arena.take<InstanceState>(1);
  for (Matrix34*& pose : to.pose_joints) pose = arena.take<Matrix34>(joints);
  for (tissue::NodePose*& pose : to.poses) pose = arena.take<tissue::NodePose>(asset.node_count());
  to.network_state = arena.take<float>(tissue::state_floats(asset.network, asset.node_count()));
  for (float*& u : to.u) u = arena.take<float>(vectors);
  for (float*& l : to.l) l = arena.take<float>(vectors);
  to.theta = arena.take<float>(vectors);
  for (float*& q : to.q) q = arena.take<float>(asset.mode_count());
  for (float*& r : to.r) r = arena.take<float>(vectors);
  for (float*& q : to.corrected) q = arena.take<float>(asset.mode_count());
  to.swing = arena.take<float>(asset.pack.regions.size());
  for (float** modes : {&to.tick_force.q, &to.tick_force.added_q, &to.tick_force.off_q})
    *modes = arena.take<float>(asset.mode_count());
  for (float** each : {&to.tick_force.r, &to.tick_force.added_r, &to.tick_force.off_r})
    *each = arena.take<float>(vectors);
  to.tail = arena.take<float>(vectors);
  to.tail_velocity = arena.take<float>(vectors);
  for (float*& shown : to.shown) shown = arena.take<float>(vectors);
  to.felt_asleep = arena.take<float>(vectors);
  to.quiet_ticks = arena.take<uint32_t>(asset.pack.regions.size());
  to.regained = arena.take<uint32_t>(asset.pack.regions.size());
  const size_t slots = asset.rods.slot_count;
  for (float** turns : {&to.rod_turn, &to.rod_shown[0], &to.rod_shown[1], &to.rod_tail})
    *turns = arena.take<float>(4 * slots);
  to.rod_tail_velocity = arena.take<float>(3 * slots);
  to.joint_teleports = arena.take<uint32_t>(joints);
  to.carried_regions = arena.take<uint32_t>(asset.pack.regions.size());
  to.carried_rods = arena.take<uint32_t>(asset.rods.rod_count);
  to.rod_asleep = arena.take<double>(4 * slots);
  to.rod_hold_asleep = arena.take<double>(size_t{3} * asset.rods.hold_count());
  for (double*& rest : to.rod_rest) rest = arena.take<double>(4 * slots);
  for (double*& hold : to.rod_hold) hold = arena.take<double>(size_t{3} * asset.rods.hold_count());
  if (to.contacts.own_body)
    for (double*& ends : to.proxy_ends) ends = arena.take<double>(6 * asset.pack.proxies.size());
  if (soft_parts_touch(asset, to.contacts)) {
    to.pushes = arena.take<float>(size_t{3} * asset.padded_vertices);
    to.pushed = arena.take<uint32_t>(asset.pack.regions.size());
    for (float*& skin : to.tick_skin)
      skin = arena.take<float>(size_t{12} * asset.pack.character->joint_count);
    for (float*& turn : to.tick_turn) turn = arena.take<float>(4);
  }
  if (asset.level_count > 1) to.seam = arena.take<float>(size_t{3} * asset.padded_vertices);
  to.region_tunings = arena.take<PartTuning>(asset.pack.regions.size());
  to.rod_tunings = arena.take<PartTuning>(asset.rods.rod_count);
  to.state_bytes = arena.used_bytes();
}

void lay_out_contacts(const Asset& asset, core::Arena& arena, Instance& to) noexcept {
  to.probes = arena.take<ContactProbe>(kProbesAtOnce);
  to.hits = arena.take<ContactHit>(kHitsAtOnce * (touches_own_body(asset, to.contacts) ? 2 : 1));
  uint32_t vertices = 0;
  for (const GraphLevel& level : asset.levels) vertices = std::max(vertices, level.patches.vertex_count);
  to.touches = arena.take<Touch>(size_t{2} * vertices);
  to.flesh = arena.take<float>(size_t{3} * asset.node_count());
  to.touched = arena.take<uint8_t>(vertices);
  to.deepest = arena.take<uint32_t>(asset.node_count());
  to.carries_pushes = arena.take<uint8_t>(asset.pack.regions.size());
  if (touches_own_body(asset, to.contacts))
    to.proxy_before = arena.take<double>(6 * asset.pack.proxies.size());
}

void lay_out_emulator(size_t nodes, core::Arena& arena, EmulatorScratch& to) noexcept {
  for (float** places : {&to.u_now, &to.u_before, &to.u_next, &to.x_now, &to.x_before, &to.x_next, &to.l})
    *places = arena.take<float>(3 * nodes);
  to.views = arena.take<tissue::PatchView>(nodes);
  to.step = arena.take<float>(tissue::deep_emulator_scratch_floats());
}

void lay_out_scratch(const Asset& asset, core::Arena& arena, Instance& to) noexcept {
  const uint32_t joints = asset.pack.character->joint_count;
  const uint32_t nodes = asset.node_count();
  to.parts_older = arena.take<JointParts>(joints);
  to.parts_before = arena.take<JointParts>(joints);
  to.parts = arena.take<JointParts>(joints);
  to.next_parts = arena.take<JointParts>(joints);
  to.tick_joints = arena.take<Matrix34>(joints);
  to.tuned_modes = arena.take<pack::ModeRecord>(asset.mode_count());
  to.tuned_slopes = arena.take<tissue::SwingSlopes>(asset.mode_count() + asset.pack.regions.size());
  to.tuned_regions = arena.take<TunedRegion>(asset.pack.regions.size());
  to.poses_now = arena.take<tissue::NodePose>(nodes);
  to.shown_between = arena.take<float>(size_t{3} * nodes);
  to.drive = arena.take<float>(size_t{tissue::kNodeDriveWidth} * nodes);
  for (float** vectors : {&to.felt, &to.l_hat, &to.r_hat, &to.carry})
    *vectors = arena.take<float>(size_t{3} * nodes);
  to.joint_size = arena.take<float>(joints);
  to.node_size = arena.take<float>(nodes);
  to.q_hat = arena.take<float>(asset.mode_count());
  for (float*& region : to.region) region = arena.take<float>(asset.widest_region);
  to.awake = arena.take<tissue::NodeRun>(asset.pack.regions.size());
  to.trust = arena.take<float>(asset.pack.regions.size());
  if (asset.level_count > 1) to.level_scratch = arena.take<float>(change_scratch_floats(asset));
  to.inputs = arena.take<float>(tissue::input_stride(asset.network) * nodes);
  to.network_scratch = arena.take<float>(tissue::scratch_floats(asset.network, nodes));
  if (asset.emulates()) lay_out_emulator(nodes, arena, to.emulator);
  to.skin = arena.take<float>(size_t{12} * joints);
  to.delta = arena.take<float>(size_t{3} * nodes);
  to.carried = arena.take<float>(size_t{3} * asset.padded_vertices);
  to.surface = arena.take<float>(size_t{3} * asset.vertex_count());
  to.areas = arena.take<float>(size_t{3} * asset.vertex_count());
  const size_t slots = asset.rods.slot_count;
  to.rod_rest_now = arena.take<double>(4 * slots);
  to.rod_hold_now = arena.take<double>(size_t{3} * asset.rods.hold_count());
  for (float** turns : {&to.rod_orientations, &to.rods_between}) *turns = arena.take<float>(4 * slots);
  to.rod_velocity = arena.take<float>(6 * slots);
  for (size_t tick = 0; tick < 2; ++tick) {
    to.rod_end[tick] = arena.take<double>(3 * slots);
  }
  to.rod_motion = arena.take<Matrix34>(slots);
  to.rod_joints = arena.take<Matrix34>(slots > 0 ? joints : 0);
}

void lay_out(const Asset& asset, core::Arena& arena, Instance& to) noexcept {
  lay_out_state(asset, arena, to);
  lay_out_scratch(asset, arena, to);
  if (soft_parts_touch(asset, to.contacts)) lay_out_contacts(asset, arena, to);
}

// Of the way into a blend.
float blended(const InstanceState& state, float ahead) noexcept {
  return std::min(1.0f, (state.blend_ticks + ahead * state.blend_pace) / kBlendInTicks);
}

}  // namespace

float Instance::simulated_share(float ahead) const noexcept {
  if (!frame::is_simulated(state->tier)) return 0;
  return smooth_step(blended(*state, ahead));
}

float Instance::tail_share(float ahead) const noexcept {
  const float faded = static_cast<float>(state->tail_ticks) + ahead - static_cast<float>(kCarryTicks);
  if (faded <= 0) return 1;
  return smooth_step(1 - std::min(faded / static_cast<float>(state->fade_ticks), 1.0f));
}

ShownShares Instance::shown_shares(float ahead) const noexcept {
  if (state->tail_rides) return {1, 1 - gentle_step(blended(*state, ahead))};
  const float b = simulated_share(ahead);
  return {b, (1 - b) * tail_share(ahead)};
}

float Instance::shown_share() const noexcept {
  if (state->tail_rides) return 1;
  const ShownShares shares = shown_shares();
  return shares.simulated + shares.tail;
}

float Instance::seam_share() const noexcept {
  if (!seam || state->seam_ticks >= kBlendInTicks) return 0;
  const float faded = (static_cast<float>(state->seam_ticks) + state->render_fraction) / kBlendInTicks;
  return smooth_step(1 - std::min(faded, 1.0f));
}

float Instance::regained_share(size_t region, float ahead) const noexcept {
  if (!regained[region] || state->seam_ticks >= kBlendInTicks) return 1;
  return smooth_step(std::min(1.0f, (static_cast<float>(state->seam_ticks) + ahead) / kBlendInTicks));
}

namespace {

Status scale_sources(const Asset& asset, Instance& instance) noexcept {
  const size_t probes = std::max(kProbesAtOnce, asset.rods.slot_count);
  ContactSource** const given[] = {&instance.contacts.source, &instance.contacts.surface};
  for (int k = 0; k < 2; ++k) {
    if (!*given[k]) continue;
    instance.scaled[k].reset(new (std::nothrow) ScaledSource(*given[k], probes));
    if (!instance.scaled[k] || !instance.scaled[k]->is_complete())
      return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for its contacts");
    *given[k] = instance.scaled[k].get();
  }
  return {};
}

}  // namespace

size_t instance_bytes(const Asset& asset) noexcept {
  core::Arena measure;
  Instance unused;
  lay_out(asset, measure, unused);
  return measure.used_bytes() + rod_batch_bytes(asset);
}

Status make_instance(Asset& asset, const InstanceDef& def, Instance* out) noexcept {
  if (Status status = check_rod_start(asset, def); !status.ok()) return status;
  core::Arena measure;
  Instance made;
  made.contacts = def.contacts;
  made.rod_start = def.rod_start;
  made.contacts.own_body &= !asset.pack.proxies.empty() && (asset.rods.rod_count > 0 || asset.touchable);
  if (asset.rods.rod_count == 0) made.contacts.surface = nullptr;
  if (Status status = scale_sources(asset, made); !status.ok()) return status;
  for (uint32_t l = 0; soft_parts_touch(asset, made.contacts) && l < asset.level_count; ++l) {
    GraphLevel& level = asset.levels[l];
    if (level.patches.first) continue;
    if (Status status = make_surface_patches(level.pack, &level.patches); !status.ok()) return status;
  }
  lay_out(asset, measure, made);
  const size_t bytes = measure.used_bytes();
  made.memory = core::AlignedBlock(bytes);
  if (!made.memory.data()) {
    return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for %zu bytes", bytes);
  }
  if (Status status = make_rod_batches(asset, def, &made.rod_batches); !status.ok()) return status;
  core::Arena arena(made.memory.data());
  lay_out(asset, arena, made);
  made.asset = &asset;
  made.asset_id = def.asset;
  made.def = def;
  made.sleep_tolerance = WorldDef{}.sleep_tolerance;
  made.most_m_s2 = TeleportDef{}.acceleration * asset.pack.character->height_m;
  new (made.state) InstanceState();
  std::uninitialized_fill_n(made.region_tunings, asset.pack.regions.size(), PartTuning());
  std::uninitialized_fill_n(made.rod_tunings, asset.rods.rod_count, PartTuning());
  std::uninitialized_fill_n(made.tuned_regions, asset.pack.regions.size(), TunedRegion());
  point_to_state(made);
  made.state->root = def.root;
  made.state->importance = frame::sane_importance(def.importance);
  bind_pose(asset.pack.joints, made.joints);
  std::copy_n(made.joints, asset.pack.character->joint_count, made.joints_older);
  std::copy_n(made.joints, asset.pack.character->joint_count, made.joints_before);
  std::copy_n(made.joints, asset.pack.character->joint_count, made.next_joints);
  bound_pose(made);
  forget_rods(made);
  if (Status status = make_rod_colliders(made); !status.ok()) return status;
  publish(made);
  *out = std::move(made);
  return {};
}

void point_to_state(Instance& instance) noexcept {
  instance.level = &instance.asset->levels[instance.state->level];
  const uint32_t first = instance.state->first_joints;
  Matrix34** const poses[] = {&instance.joints_older, &instance.joints_before, &instance.joints,
                              &instance.next_joints};
  for (uint32_t k = 0; k < 4; ++k) *poses[k] = instance.pose_joints[(first + k) % 4];
}

void forget_displacement(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const size_t bytes = sizeof(float) * 3 * instance.level->node_count();
  for (float* shown : instance.shown) std::memset(shown, 0, bytes);
  std::memset(instance.tail, 0, bytes);
  std::memset(instance.tail_velocity, 0, bytes);
  forget_rods(instance);
  forget_carried(instance);
  forget_pushes(instance);
  instance.told = {};
  state.motion_stale = 1;
  state.restarting = 0;
  state.forgotten = 1;
  state.untouched = 1;
  state.tier = Tier::kSkinning;  // so that simulation starts anew, from zero
  state.fallback_ticks = 0;
  state.tail_ticks = kCarryTicks + kFadeTicks;
  state.tail_rides = 0;
  state.fade_ticks = kFadeTicks;
  state.rest_ticks = 0;
  state.seam_ticks = kBlendInTicks;
}

void forget_motion(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  forget_displacement(instance);
  state.at_start = 1;
  instance.displaced = false;
  state.still_ticks = 0;
  state.skips_pose = 0;
  state.without_pose_s = 0;
  wake(instance);
  state.render_fraction = 0;
  forget_teleports(instance);
  state.excitation = 1;
  std::fill_n(state.velocity_m_s, 3, 0.0);
  std::fill_n(state.angular_velocity, 3, 0.0);
}

namespace {

TierReason reason_of(const Instance& instance, uint32_t asleep) noexcept {
  const InstanceState& state = *instance.state;
  if (state.hidden) return TierReason::kHidden;
  if (instance.cut || instance.held) return TierReason::kCut;
  if (state.restarting || state.fallback_ticks > 0) return TierReason::kGuard;
  const GraphLevel& level = *instance.level;
  if (frame::is_simulated(state.tier) && asleep + level.regions_left_out() == level.pack.regions.size())
    return TierReason::kStill;
  const bool overdue = !frame::is_simulated(state.tier) && state.waited_s > frame::kLongestWait_s;
  return overdue ? TierReason::kWaiting : instance.plan.why;
}

}  // namespace

InstanceReport describe(const Instance& instance, InstanceId id) noexcept {
  const InstanceState& state = *instance.state;
  const float blend = instance.shown_share();
  const bool simulated = frame::is_simulated(state.tier);
  const uint32_t asleep = simulated ? regions_asleep(instance) : 0;
  const auto scale = static_cast<float>(state.root.scale);
  return {.instance = id,
          .tier = simulated || blend > 0 ? state.tier : Tier::kSkinning,
          .why = reason_of(instance, asleep),
          .error = state.hidden ? 1 : error_of(*instance.asset, state.tier, state.level),
          .graph_level = state.level,
          .blend = blend,
          .ticks_since_network = state.ticks_since_network,
          .input_clamps = state.input_clamps,
          .displacement_clamps = state.displacement_clamps,
          .fallbacks = state.fallbacks,
          .restarts = state.restarts,
          .regions_asleep = asleep,
          .regions_left_out = simulated ? instance.level->regions_left_out() : 0,
          .teleports = state.root_teleports,
          .part_teleports = state.part_teleports,
          .rod_recoveries = state.rod_recoveries,
          .rods_asleep = simulated ? rods_asleep(instance) : 0,
          .rod_iterations = instance.told.rod_iterations,
          .rod_residual = instance.told.rod_residual,
          .rod_contacts = instance.told.rod_contacts,
          .rods_touch_surface = simulated && touches_surface(instance),
          .vertices_touched = instance.told.vertices,
          .contacts_refused = instance.told.refused,
          .contacts_dropped = instance.told.dropped,
          .contact_volume_m3 = instance.told.volume_m3 * scale * scale * scale,
          .deepest_penetration_m = instance.told.deepest_m * scale,
          .cost_us = core::microseconds(instance.times.total_ns),
          .planned_us = state.hidden ? 0 : instance.plan.cost_us,
          .hidden = state.hidden != 0,
          .dormant = state.dormant != 0};
}

}  // namespace sinew::world
