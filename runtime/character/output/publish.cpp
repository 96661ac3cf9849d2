// publish.cpp  What is shown at the end of a step, brought to the surface.
#include "character/output/publish.hpp"

#include <bit>
#include <cstring>
#include <utility>

#include "character/motion/pose.hpp"
#include "character/output/between_ticks.hpp"
#include "character/output/displacement_bound.hpp"
#include "character/rods/rod_blend.hpp"
#include "character/rods/rod_publish.hpp"
#include "character/transition/shares.hpp"
#include "core/clock.hpp"
#include "kernels/kernels.hpp"

namespace sinew::world {
namespace {

bool put(float value, float& to) noexcept {
  const bool changed = std::bit_cast<uint32_t>(value) != std::bit_cast<uint32_t>(to);
  to = value;
  return changed;
}

// True when any bit of a region's delta is new. Of a tail it is what is left once its fading is left out:
// carried_share has that.
bool take_shown(Published& published, const pack::RegionRecord& region, const float* shown) noexcept {
  const size_t begin = size_t{3} * region.first_node, end = begin + size_t{3} * region.node_count;
  bool changed = false;
  for (size_t i = begin; i < end; ++i) changed |= put(shown[i], published.delta[i]);
  return changed;
}

// Vertices that touched something in the last tick. True when `carried` has to be made anew for it.
bool takes_pushes(const ContactState& contacts, size_t r) noexcept {
  return contacts.pushes && (contacts.pushed[r] || contacts.carries_pushes[r]);
}

// True when `carried` has to be made anew for what a change of level left, or for its level itself.
bool takes_seam(Instance& instance, float share) noexcept {
  const bool had = std::exchange(instance.published.carries_seam, share > 0);
  return std::exchange(instance.published.carried_level, instance.state->level) != instance.state->level ||
         had || share > 0;
}

void add_seam(const TransitionState& transition, float share, size_t first, size_t floats,
              float* carried) noexcept {
  for (size_t i = 0; i < floats; ++i) carried[i] += share * transition.seam[first + i];
}

void add_pushes(Instance& instance, size_t r, size_t first, float* carried) noexcept {
  const size_t floats = size_t{3} * instance.level->pack.regions[r].padded_vertices;
  instance.contacts.carries_pushes[r] = instance.contacts.pushed[r] != 0;
  for (size_t i = 0; i < floats; ++i) carried[i] += instance.contacts.pushes[first + i];
}

// Nothing is left of it, so that coming back starts from rest.
void clear_shown(Instance& instance) noexcept {
  const size_t bytes = sizeof(float) * 3 * instance.level->node_count();
  for (float* shown : instance.transition.shown) std::memset(shown, 0, bytes);
  instance.state->transition.seam_ticks = kBlendInTicks;
}

struct Shown {
  const float *displacement, *turns;  // of nodes, and of rods' segments
};

Shown shown_at_end(Instance& instance, const ClockHook& clock) noexcept {
  const InstanceState& state = *instance.state;
  const bool steps =
      (state.poses.render_fraction > 0 || state.tissue.is_off) && frame::is_simulated(state.tier);
  const uint64_t start_ns = steps ? core::now_ns(clock) : 0;
  const Shown shown{shown_now(instance), rods_shown_now(instance)};
  instance.times.between_ns = steps ? core::now_ns(clock) - start_ns : 0;
  return shown;
}

}  // namespace

void publish_pose(Instance& instance) noexcept {
  publish_rods(instance, instance.rods.published);
  if (!skins_on_reading(instance))
    skin_matrices(instance.level->pack.joints, shown_joints(instance), instance.motion.skin);
}

void publish(Instance& instance, const ClockHook& clock) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const bool displaced = shown_share(instance) > 0;
  const Shown now = shown_at_end(instance, clock);
  instance.rods.published = now.turns;
  publish_pose(instance);
  if (std::exchange(instance.marks.displaced, displaced) && !displaced) clear_shown(instance);
  if (!displaced) return;
  instance.published.carried_share = frame::is_simulated(instance.state->tier)
                                         ? 1
                                         : tail_share(instance, instance.state->poses.render_fraction);
  float* carried = instance.published.carried;
  const float seam = seam_share(instance);
  const bool seamed = takes_seam(instance, seam);
  for (size_t r = 0; r < pack.regions.size(); ++r) {
    const pack::RegionRecord& region = pack.regions[r];
    const bool moved = take_shown(instance.published, region, now.displacement),
               pushed = takes_pushes(instance.contacts, r);
    const size_t first = static_cast<size_t>(carried - instance.published.carried);
    if (moved || pushed || seamed)
      simd::kernels().carry(pack.carry.data() + region.carry, region.node_count, region.padded_vertices,
                            instance.published.delta + size_t{3} * region.first_node, carried);
    if (seam > 0) add_seam(instance.transition, seam, first, size_t{3} * region.padded_vertices, carried);
    if (pushed) add_pushes(instance, r, first, carried);
    if (moved || pushed || seamed)
      hold_within_bound(displacement_bound_m(*instance.asset, r), region.padded_vertices, carried);
    carried += size_t{3} * region.padded_vertices;
  }
}

}  // namespace sinew::world
