// change_level.cpp  see change_level.hpp.
#include "character/transition/change_level.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "character/motion/motion.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "character/transition/shares.hpp"
#include "character/transition/simulated_shown.hpp"
#include "kernels/kernels.hpp"
#include "tissue/frames/node_bend.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"
#include "tissue/network/memory_rows.hpp"

namespace sinew::world {
namespace {

// ---- the seam ----

void carry_delta(Instance& instance) noexcept {
  const pack::PackView& pack = instance.level->pack;
  float* carried = instance.published.carried;
  for (const pack::RegionRecord& region : pack.regions) {
    simd::kernels().carry(pack.carry.data() + region.carry, region.node_count, region.padded_vertices,
                          instance.published.delta + size_t{3} * region.first_node, carried);
    carried += size_t{3} * region.padded_vertices;
  }
}

// As it would be published at the last tick.
void carry_shown(Instance& instance) noexcept {
  std::copy_n(instance.transition.shown[0], size_t{3} * instance.level->node_count(),
              instance.published.delta);
  carry_delta(instance);
}

void take_from_seam(Instance& instance) noexcept {
  for (size_t i = 0; i < size_t{3} * instance.asset->padded_vertices; ++i)
    instance.transition.seam[i] -= instance.published.carried[i];
}

void begin_seam(Instance& instance) noexcept {
  const float left = seam_share(instance);
  carry_shown(instance);
  for (size_t i = 0; i < size_t{3} * instance.asset->padded_vertices; ++i)
    instance.transition.seam[i] =
        (left > 0 ? left * instance.transition.seam[i] : 0) + instance.published.carried[i];
}

// Of regions that are left out: they fade with all else.
void take_pushes(Instance& instance, const GraphLevel& to) noexcept {
  size_t first = 0;
  for (size_t r = 0; r < to.pack.regions.size(); ++r) {
    const size_t floats = size_t{3} * to.pack.regions[r].padded_vertices;
    if (to.leaves_out(r) && instance.contacts.pushed[r]) {
      for (size_t i = first; i < first + floats; ++i)
        instance.transition.seam[i] += std::exchange(instance.contacts.pushes[i], 0.0f);
      instance.contacts.pushed[r] = 0;
    }
    first += floats;
  }
}

void end_seam(Instance& instance) noexcept {
  carry_shown(instance);
  take_from_seam(instance);
  instance.published.carries_seam = true;  // `carried` is nothing that may be shown
}

// ---- to the next coarser level ----

template <class T>
void pick(std::span<const uint32_t> picks, size_t width, T* rows) noexcept {
  for (size_t n = 0; n < picks.size(); ++n)  // picks ascend: nothing is written that is still to be read
    std::memmove(rows + width * n, rows + width * picks[n], width * sizeof(T));
}

// Where it is had again, it begins at rest.
void forget_left_out(TissueState& tissue, const GraphLevel& coarse) noexcept {
  for (size_t r = 0; r < coarse.pack.regions.size(); ++r) {
    if (!coarse.leaves_out(r)) continue;
    const pack::RegionModesRecord& modes = coarse.pack.region_modes[r];
    for (float* const* ticks : {tissue.q, tissue.corrected})
      for (int tick = 0; tick < 2; ++tick)
        std::fill_n(ticks[tick] + modes.first_mode, modes.mode_count, 0.0f);
  }
}

void lower(Instance& instance) noexcept {
  const uint32_t nodes = instance.level->node_count();
  const std::span<const uint32_t> picks = instance.level[1].pack.picks;
  for (float* const* ticks :
       {instance.tissue.u, instance.tissue.l, instance.tissue.r, instance.transition.shown})
    for (int tick = 0; tick < 2; ++tick) pick(picks, 3, ticks[tick]);
  for (float* vectors : {instance.tissue.theta, instance.transition.tail, instance.transition.tail_velocity})
    pick(picks, 3, vectors);
  for (tissue::NodePose* poses : instance.motion.poses) pick(picks, 1, poses);
  tissue::pick_memory(instance.asset->network, nodes, picks, instance.tissue.network_memory);
  forget_left_out(instance.tissue, instance.level[1]);
}

// ---- to the next finer level ----

struct Scratch {
  float *before, *carried;
  uint32_t* sources;
};

// A plane of the network's memory or an array of vectors; a region as `carry` leaves it; a number a node.
size_t plane_floats(const Asset& asset) noexcept {
  size_t widest = 16;
  for (const pack::LayerRecord& layer : asset.network.layers) widest = std::max<size_t>(widest, layer.padded);
  return widest * asset.node_count();
}

Scratch scratch_of(const Instance& instance) noexcept {
  float* at = instance.transition.level_scratch;
  const size_t plane = pack::round_up_16(plane_floats(*instance.asset));
  return {at, at + plane, reinterpret_cast<uint32_t*>(at + plane + 3 * instance.asset->widest_region)};
}

// Work(region of the coarser level, region of the finer one, weights, their stride).
template <class Work>
void for_each_region(const GraphLevel& coarse, const GraphLevel& fine, Work work) noexcept {
  const float* weights = coarse.pack.spread.data();
  for (size_t r = 0; r < fine.pack.regions.size(); ++r) {
    const pack::RegionRecord &from = coarse.pack.regions[r], &to = fine.pack.regions[r];
    const auto stride = static_cast<size_t>(pack::round_up_16(to.node_count));
    work(from, to, weights, stride);
    weights += stride * from.node_count;
  }
}

// [coarser nodes][3] to [finer nodes][3], in place.
void spread(const Instance& instance, const GraphLevel& fine, float* vectors) noexcept {
  const GraphLevel& coarse = *instance.level;
  const Scratch scratch = scratch_of(instance);
  std::copy_n(vectors, size_t{3} * coarse.node_count(), scratch.before);
  for_each_region(coarse, fine, [&](const auto& from, const auto& to, const float* weights, size_t stride) {
    simd::kernels().carry(weights, from.node_count, stride, scratch.before + size_t{3} * from.first_node,
                          scratch.carried);
    float* out = vectors + size_t{3} * to.first_node;
    if (from.node_count == to.node_count) {  // the same nodes
      std::copy_n(scratch.before + size_t{3} * from.first_node, size_t{3} * to.node_count, out);
      return;
    }
    for (size_t n = 0; n < to.node_count; ++n)
      for (size_t axis = 0; axis < 3; ++axis) out[3 * n + axis] = scratch.carried[axis * stride + n];
  });
}

// l += sign shape q, at a level.
void add_modes(const TissueState& tissue, const GraphLevel& level, const float* q, float sign,
               float* l) noexcept {
  float* held = tissue.region[0];
  for (size_t r = 0; r < level.pack.regions.size(); ++r) {
    const tissue::ModalBase base = tissue::modal_base(level.pack, r);
    simd::kernels().add_rows(base.shape, static_cast<uint32_t>(base.modes.size()), base.padded,
                             q + level.pack.region_modes[r].first_mode, held);
    float* at = l + size_t{3} * level.pack.regions[r].first_node;
    for (size_t i = 0; i < size_t{3} * base.node_count; ++i) at[i] += sign * held[i];
  }
}

void turn_and_warp(const Instance& instance, const GraphLevel& level, int tick) noexcept {
  for (size_t r = 0; r < level.pack.regions.size(); ++r) {
    const size_t vector = size_t{3} * level.pack.regions[r].first_node;
    tissue::modal_turn(tissue::modal_base(level.pack, r),
                       instance.tissue.q[tick] + level.pack.region_modes[r].first_mode,
                       instance.tissue.region[0], instance.tissue.theta + vector);
    tissue::warp(instance.tissue.theta + vector, instance.tissue.l[tick] + vector,
                 level.pack.regions[r].node_count, instance.tissue.u[tick] + vector);
    tissue::hold_within(limit_m(instance, r), level.pack.regions[r].node_count,
                        instance.tissue.u[tick] + vector);
  }
}

void raise_base(Instance& instance, const GraphLevel& fine) noexcept {
  for (int tick = 1; tick >= 0; --tick) {  // theta is the newer tick's
    add_modes(instance.tissue, *instance.level, instance.tissue.q[tick], -1, instance.tissue.l[tick]);
    spread(instance, fine, instance.tissue.l[tick]);
    spread(instance, fine, instance.tissue.r[tick]);
    add_modes(instance.tissue, fine, instance.tissue.q[tick], 1, instance.tissue.l[tick]);
    turn_and_warp(instance, fine, tick);
  }
}

// Of the coarser nodes of its region the one with the largest weight on a finer one.
uint32_t source_of(const pack::RegionRecord& from, const pack::RegionRecord& to, const float* weights,
                   size_t stride, uint32_t n) noexcept {
  if (from.node_count == 0) return pack::kNoIndex;
  if (from.node_count == to.node_count) return from.first_node + n;  // the same nodes
  uint32_t most = 0;
  for (uint32_t c = 1; c < from.node_count; ++c)
    if (weights[c * stride + n] > weights[most * stride + n]) most = c;
  return from.first_node + most;
}

void find_sources(const Instance& instance, const GraphLevel& fine, uint32_t* sources) noexcept {
  for_each_region(*instance.level, fine,
                  [&](const auto& from, const auto& to, const float* weights, size_t stride) {
                    for (uint32_t n = 0; n < to.node_count; ++n)
                      sources[to.first_node + n] = source_of(from, to, weights, stride, n);
                  });
}

void raise_memory(Instance& instance, const GraphLevel& fine) noexcept {
  const Scratch scratch = scratch_of(instance);
  const tissue::Network& network = instance.asset->network;
  find_sources(instance, fine, scratch.sources);
  tissue::copy_memory(network, instance.level->node_count(), {scratch.sources, fine.node_count()},
                      instance.tissue.network_memory, scratch.before);
  if (instance.state->tier == Tier::kNetwork)
    tissue::write_output(network, fine.pack.regions, fine.node_count(), instance.tissue.l[0],
                         instance.tissue.network_memory);
}

void raise(Instance& instance) noexcept {
  const GraphLevel& fine = instance.level[-1];
  for (float* vectors : {instance.transition.shown[0], instance.transition.shown[1], instance.transition.tail,
                         instance.transition.tail_velocity})
    spread(instance, fine, vectors);
  if (frame::is_simulated(instance.state->tier)) raise_base(instance, fine);
  raise_memory(instance, fine);
  for (size_t r = 0; r < fine.pack.regions.size(); ++r)
    if (instance.level->leaves_out(r) && !fine.leaves_out(r)) instance.transition.regained[r] = kRegainedNow;
  instance.marks.level_raised = true;
}

// What is shown at the level it has now, of what is simulated.
void show_anew(Instance& instance) noexcept {
  const ShownShares shares = shown_shares(instance);
  const uint32_t nodes = instance.level->node_count();
  if (instance.marks.level_raised) pose_now(instance, instance.motion.poses[0]);
  for (int tick = 0; tick < 2; ++tick) {
    take_simulated(instance, tick, instance.transition.shown[tick]);
    for (size_t i = 0; (shares.simulated < 1 || shares.tail > 0) && i < size_t{3} * nodes; ++i)
      instance.transition.shown[tick][i] =
          shares.simulated * instance.transition.shown[tick][i] + shares.tail * instance.transition.tail[i];
  }
}

void go_one_level(Instance& instance, bool finer) noexcept {
  if (finer)
    raise(instance);
  else
    lower(instance);
  instance.state->level += finer ? -1u : 1u;
  point_to_state(instance);
}

// Nothing is seen of it: the seam takes it.
void show_settled(Instance& instance, const float* moved) noexcept {
  const float simulated = shown_shares(instance).simulated;
  tissue::along_flesh(instance.motion.poses[1], moved, instance.level->node_count(),
                      instance.published.delta);  // those of u: a tick ago
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    const float share = simulated * regained_share(instance, r) * intensity_of(instance, r);
    float* delta = instance.published.delta + size_t{3} * region.first_node;
    for (size_t i = 0; i < size_t{3} * region.node_count; ++i) delta[i] *= share;
  }
  for (float* shown : instance.transition.shown)
    for (size_t i = 0; i < size_t{3} * instance.level->node_count(); ++i)
      shown[i] += instance.published.delta[i];
  carry_delta(instance);
  if (instance.state->transition.seam_ticks < kBlendInTicks) take_from_seam(instance);
}

// Nothing is shown of it, and no network remembers anything.
bool carries_nothing(const Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const bool forgotten = state.tissue.forgotten || state.tissue.ticks_since_network > kRememberedTicks;
  return !instance.marks.displaced && !frame::is_simulated(state.tier) && forgotten;
}

void begin_at_level(Instance& instance, uint32_t level) noexcept {
  InstanceState& state = *instance.state;
  state.level = level;
  point_to_state(instance);
  for (float* none : {instance.transition.shown[0], instance.transition.shown[1], instance.transition.tail,
                      instance.transition.tail_velocity})
    std::memset(none, 0, sizeof(float) * 3 * instance.level->node_count());
  std::fill_n(instance.transition.regained, instance.level->pack.regions.size(), 0u);
  wake_regions(instance);
  state.transition.seam_ticks = kBlendInTicks;
  state.poses.motion_stale = 1;
}

}  // namespace

void settle_rest(Instance& instance, const float* moved) noexcept {
  const uint32_t nodes = instance.level->node_count();
  for (float* u : instance.tissue.u)
    for (size_t i = 0; i < size_t{3} * nodes; ++i) u[i] += moved[i];
  if (shown_shares(instance).simulated > 0) show_settled(instance, moved);
  if (instance.state->tier == Tier::kNetwork)
    tissue::write_output(instance.asset->network, instance.level->pack.regions, nodes, instance.tissue.l[0],
                         instance.tissue.network_memory);
}

void lay_out_scratch(const Asset& asset, core::Arena& arena, TransitionState& to) noexcept {
  if (asset.level_count == 1) return;
  to.level_scratch = arena.take<float>(pack::round_up_16(plane_floats(asset)) +
                                       size_t{3} * asset.widest_region + asset.node_count());
}

void change_level(Instance& instance, uint32_t level) noexcept {
  InstanceState& state = *instance.state;
  if (state.level == level) return;
  if (carries_nothing(instance)) return begin_at_level(instance, level);
  const bool shows = instance.marks.displaced;
  if (shows) begin_seam(instance);
  if (shows && instance.contacts.pushes) take_pushes(instance, instance.asset->levels[level]);
  uint32_t* const regained_end = instance.transition.regained + instance.level->pack.regions.size();
  if (state.transition.seam_ticks == kBlendInTicks) std::fill(instance.transition.regained, regained_end, 0u);
  while (state.level != level) go_one_level(instance, level < state.level);
  state.transition.seam_ticks = shows ? 0 : kBlendInTicks;
  const bool ramps =
      std::any_of(instance.transition.regained, regained_end, [](uint32_t is) { return is != 0; });
  if ((instance.marks.level_raised || ramps) && frame::is_simulated(state.tier)) show_anew(instance);
  if (shows) end_seam(instance);
  wake_regions(instance);
}

}  // namespace sinew::world
