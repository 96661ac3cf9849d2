// tissue_state.cpp  see tissue_state.hpp.
#include "character/tissue/tissue_state.hpp"

#include "tissue/frames/node_drive.hpp"
#include "tissue/network/inputs.hpp"
#include "tissue/network/network.hpp"

namespace sinew::world {
namespace {

void lay_out_emulator(size_t nodes, core::Arena& arena, EmulatorScratch& to) noexcept {
  for (float** places : {&to.u_now, &to.u_before, &to.u_next, &to.x_now, &to.x_before, &to.x_next, &to.l})
    *places = arena.take<float>(3 * nodes);
  to.views = arena.take<tissue::PatchView>(nodes);
  to.step = arena.take<float>(tissue::deep_emulator_scratch_floats());
}

}  // namespace

void lay_out_state(const Asset& asset, core::Arena& arena, TissueState& to) noexcept {
  const size_t vectors = size_t{3} * asset.node_count(), regions = asset.pack.regions.size();
  to.network_memory = arena.take<float>(tissue::state_floats(asset.network, asset.node_count()));
  for (float*& u : to.u) u = arena.take<float>(vectors);
  for (float*& l : to.l) l = arena.take<float>(vectors);
  to.theta = arena.take<float>(vectors);
  for (float*& q : to.q) q = arena.take<float>(asset.mode_count());
  for (float*& r : to.r) r = arena.take<float>(vectors);
  for (float*& q : to.corrected) q = arena.take<float>(asset.mode_count());
  to.swing = arena.take<float>(regions);
  for (float** modes : {&to.tick_force.q, &to.tick_force.added_q, &to.tick_force.off_q})
    *modes = arena.take<float>(asset.mode_count());
  for (float** each : {&to.tick_force.r, &to.tick_force.added_r, &to.tick_force.off_r})
    *each = arena.take<float>(vectors);
  to.felt_asleep = arena.take<float>(vectors);
  to.quiet_ticks = arena.take<uint32_t>(regions);
}

void lay_out_scratch(const Asset& asset, core::Arena& arena, TissueState& to) noexcept {
  const uint32_t nodes = asset.node_count();
  to.drive = arena.take<float>(size_t{tissue::kNodeDriveWidth} * nodes);
  for (float** vectors : {&to.felt, &to.l_hat, &to.r_hat, &to.carry})
    *vectors = arena.take<float>(size_t{3} * nodes);
  to.q_hat = arena.take<float>(asset.mode_count());
  for (float*& region : to.region) region = arena.take<float>(asset.widest_region);
  to.awake = arena.take<tissue::NodeRun>(asset.pack.regions.size());
  to.trust = arena.take<float>(asset.pack.regions.size());
  to.inputs = arena.take<float>(tissue::input_stride(asset.network) * nodes);
  to.network_scratch = arena.take<float>(tissue::scratch_floats(asset.network, nodes));
  if (asset.emulates()) lay_out_emulator(nodes, arena, to.emulator);
}

}  // namespace sinew::world
