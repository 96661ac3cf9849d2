// lay_out.cpp  Where the arrays of an instance lie in its one block of memory.
#include "character/life/lay_out.hpp"

#include <algorithm>

#include "character/parameters/tuned_parts.hpp"
#include "character/transition/change_level.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/network/inputs.hpp"
#include "tissue/network/network.hpp"

namespace sinew::world {

bool touches_own_body(const Asset& asset, const ContactDef& contacts) noexcept {
  return contacts.own_body && asset.touchable != nullptr;
}

bool soft_parts_touch(const Asset& asset, const ContactDef& contacts) noexcept {
  return contacts.source || touches_own_body(asset, contacts);
}

namespace {

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

}  // namespace

void lay_out(const Asset& asset, core::Arena& arena, Instance& to) noexcept {
  lay_out_state(asset, arena, to);
  lay_out_scratch(asset, arena, to);
  if (soft_parts_touch(asset, to.contacts)) lay_out_contacts(asset, arena, to);
}

}  // namespace sinew::world
