// tuned_parts.cpp  see tuned_parts.hpp.
#include "character/parameters/tuned_parts.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::world {

void tune_base(const Instance& instance, size_t region, tissue::ModalBase* base) noexcept {
  const TunedRegion& tuned = instance.parameters.tuned_regions[region];
  if (!tuned.on) return;
  const uint32_t first = instance.level->pack.region_modes[region].first_mode;
  base->modes = {instance.parameters.tuned_modes + first, base->modes.size()};
  base->rest_a1 = tuned.rest.a1;
  base->rest_a2 = tuned.rest.a2;
  base->rest_gain = tuned.rest_gain;
}

const tissue::SwingSlopes* slopes_of(const Instance& instance, size_t region) noexcept {
  const size_t first = instance.level->pack.region_modes[region].first_mode + region;
  const bool tuned = tunes_parts(instance) && instance.parameters.tuned_regions[region].on;
  return (tuned ? instance.parameters.tuned_slopes : instance.level->swing_slopes.get()) + first;
}

tissue::Recurrence first_recurrence(const Instance& instance, size_t region) noexcept {
  const pack::RegionModesRecord& baked = instance.level->pack.region_modes[region];
  if (tunes_parts(instance) && instance.parameters.tuned_regions[region].on)
    return instance.parameters.tuned_regions[region].first;
  return {baked.first_a1, baked.first_a2};
}

float first_rad_per_s(const Instance& instance, size_t region) noexcept {
  const float baked = instance.level->pack.region_modes[region].first_rad_per_s;
  if (!tunes_parts(instance) || !instance.parameters.tuned_regions[region].on) return baked;
  return std::sqrt(stiffness_of(instance.parameters.region_tunings[region])) * baked;
}

float limit_m(const Instance& instance, size_t region, float x) noexcept {
  const float baked_m = instance.level->pack.regions[region].displacement_limit_m;
  return tunes_parts(instance) ? displacement_of(instance.parameters.region_tunings[region], x) * baked_m
                               : baked_m;
}

float shown_limit_m(const Instance& instance, size_t region) noexcept {
  constexpr float kMost = kMostIntensity * kMostDisplacement;  // what fades may be of other numbers
  const float baked_m = instance.level->pack.regions[region].displacement_limit_m;
  return tunes_parts(instance) ? kMost * baked_m : baked_m;
}

float network_share(const Instance& instance, size_t region) noexcept {
  constexpr float kFarthest = 0.2231436f;  // log 1.25
  if (!tunes_parts(instance) || !instance.parameters.tuned_regions[region].on) return 1;
  const PartTuning& part = instance.parameters.region_tunings[region];
  const float damping = std::abs(std::log(std::max(part.damping.next, 1e-6f)));
  const float off = std::max(std::abs(part.log_stiffness.next), damping) / kFarthest;
  const float near = 1 - std::min(off, 1.0f);
  return near * near * (3 - 2 * near);
}

bool region_is_off(const Instance& instance, size_t region) noexcept {
  return tunes_parts(instance) && instance.parameters.region_tunings[region].off == kOff;
}

bool rods_are_off(const Instance& instance) noexcept {
  const PartTuning* rods = instance.parameters.rod_tunings;
  return tunes_parts(instance) && std::all_of(rods, rods + instance.asset->rods.rod_count,
                                              [](const PartTuning& part) { return part.off == kOff; });
}

float intensity_of(const Instance& instance, size_t region, float x) noexcept {
  return tunes_parts(instance) ? between(instance.parameters.region_tunings[region].intensity, x) : 1;
}

void keep_intensity(const Instance& instance, float* shown, float x) noexcept {
  if (!tunes_parts(instance)) return;
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    const float share = intensity_of(instance, r, x);
    float* at = shown + size_t{3} * region.first_node;
    for (size_t i = 0; share != 1 && i < size_t{3} * region.node_count; ++i) at[i] *= share;
  }
}

void take_out_intensity(const Instance& instance, float* shown) noexcept {
  constexpr float kLeast = 0.25f;
  if (!tunes_parts(instance)) return;
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    const float intensity = intensity_of(instance, r),
                by = intensity > 0 ? 1 / std::max(intensity, kLeast) : 0;
    float* at = shown + size_t{3} * region.first_node;
    for (size_t i = 0; by != 1 && i < size_t{3} * region.node_count; ++i) at[i] *= by;
  }
}

RodShown rod_shown(const Instance& instance, uint32_t rod, float x) noexcept {
  constexpr float kLeast_rad = 1e-6f;  // 0 would be none
  const float limit_rad = instance.asset->rods.seats()[rod].turn_limit_rad;
  if (!tunes_parts(instance)) return {limit_rad, 1};
  const PartTuning& part = instance.parameters.rod_tunings[rod];
  const float tuned_rad = limit_rad > 0 ? std::max(kLeast_rad, displacement_of(part, x) * limit_rad) : 0;
  return {tuned_rad, between(part.intensity, x)};
}

// A joint's damping ratio is w damping_s / 2. Damping leads the rest shape by as many ticks' motion as it
// lasts (character/rods/rod_motion.cpp), which is exact for turns that are small: a change makes it last no
// longer than half a second at 60 Hz, where most rods creep.
float rod_damping_share(const Instance& instance, uint32_t rod) noexcept {
  constexpr double kLongestTicks = 30;
  if (!tunes_parts(instance)) return 1;
  const PartTuning& part = instance.parameters.rod_tunings[rod];
  const RodRig& rig = instance.asset->rods;
  const float baked_s = rig.slots()[rig.seats()[rod].first_slot + 1].damping_s;
  const auto longest_s = static_cast<float>(kLongestTicks * instance.asset->tick_s);
  return std::min(part.damping.next / std::sqrt(stiffness_of(part)),
                  baked_s > 0 ? std::max(1.0f, longest_s / baked_s) : 1);
}

}  // namespace sinew::world
