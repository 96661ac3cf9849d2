// tuning.cpp  see tuning.hpp.
#include "character/parameters/tuning.hpp"

#include <algorithm>
#include <cmath>

#include "character/output/displacement_bound.hpp"
#include "character/parameters/air.hpp"
#include "character/parameters/glide.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"

namespace sinew::world {
namespace {

// Of numbers about 1, and of the logarithm of one.
constexpr float kRounding = 1e-4f;

// What the gliding numbers of a part go to.
struct Targets {
  float intensity, log_stiffness, damping, root_displacement;
  bool enabled;
  float fastest_log = kAnySpeed;  // of log_stiffness, a tick
};

Targets targets_of(const InstanceState& state, const PartTuning& part) noexcept {
  const SetParameters &all = state.parameters.all, &own = part.set;
  const bool enabled = all.enabled && own.enabled;
  const float stiffness = std::clamp(all.stiffness * own.stiffness, kLeastStiffness, kMostStiffness);
  return {.intensity = enabled ? std::min(all.intensity * own.intensity, kMostIntensity) : 0,
          .log_stiffness = static_cast<float>(std::log(double{stiffness})),
          .damping = std::min(all.damping * own.damping, kMostDamping),
          .root_displacement = std::sqrt(std::min(all.displacement * own.displacement, kMostDisplacement)),
          .enabled = enabled};
}

// A tick, at most. Far softer flesh is bent further than is shown, and what swings beneath a limit further
// than it: what comes back into sight is to be seen coming. A region's stiffness becomes ten times another in
// 19 ticks, a rod's in 38, and what the glide takes at its ends.
constexpr float kFastestOfRegion = 0.12f, kFastestOfRod = 0.06f, kFastestRootDisplacement = 0.06f;

template <class Part, class Work>
void for_each_number(Part& part, const Targets& targets, Work work) noexcept {
  work(part.intensity, targets.intensity, kAnySpeed);
  work(part.log_stiffness, targets.log_stiffness, targets.fastest_log);
  work(part.damping, targets.damping, kAnySpeed);
  work(part.root_displacement, targets.root_displacement, kFastestRootDisplacement);
}

bool is_default(const SetParameters& set) noexcept {
  return set.intensity == 1 && set.stiffness == 1 && set.damping == 1 && set.displacement == 1 && set.enabled;
}

bool is_as_baked(const PartTuning& part) noexcept {
  bool as_baked = is_default(part.set) && part.off == 0;
  for_each_number(part, {1, 0, 1, 1, true},
                  [&](const Gliding& number, float baked, float) { as_baked &= stands_at(number, baked); });
  return as_baked;
}

template <class Work>
void for_each_tuning(const Instance& instance, Work work) noexcept {
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r)
    work(instance.parameters.region_tunings[r]);
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod)
    work(instance.parameters.rod_tunings[rod]);
}

bool all_are_as_baked(const Instance& instance) noexcept {
  bool as_baked = is_default(instance.state->parameters.all);
  for_each_tuning(instance, [&](const PartTuning& part) { as_baked = as_baked && is_as_baked(part); });
  return as_baked;
}

// ---- what follows from the numbers ----

float stiffens(const PartTuning& part) noexcept {
  return std::max(0.0f, part.log_stiffness.next - part.log_stiffness.now);
}

void retune_modes(Instance& instance, size_t r, const tissue::Retuning& by) noexcept {
  const pack::RegionModesRecord& region = instance.level->pack.region_modes[r];
  const auto tick_s = static_cast<float>(instance.asset->tick_s);
  tissue::SwingSlopes* slopes = instance.parameters.tuned_slopes + region.first_mode + r;
  for (uint32_t m = region.first_mode; m < region.first_mode + region.mode_count; ++m) {
    const pack::ModeRecord mode = tissue::retuned(instance.level->pack.modes[m], by, tick_s);
    instance.parameters.tuned_modes[m] = mode;
    *slopes++ = tissue::swing_slopes(mode.a1, mode.a2);
  }
  TunedRegion& tuned = instance.parameters.tuned_regions[r];
  tuned.rest = tissue::retuned({region.rest_a1, region.rest_a2}, by);
  tuned.rest_gain = (1 - tuned.rest.a1 - tuned.rest.a2) / by.stiffness;
  tuned.first = tissue::retuned({region.first_a1, region.first_a2}, by);
  *slopes = tissue::swing_slopes(tuned.rest.a1, tuned.rest.a2);
}

void retune_region(Instance& instance, size_t r) noexcept {
  const PartTuning& part = instance.parameters.region_tunings[r];
  const tissue::Retuning by{stiffness_of(part), part.damping.next, stiffens(part)};
  instance.parameters.tuned_regions[r].stiffens = by.stiffens;
  instance.parameters.tuned_regions[r].on = by.stiffness != 1 || by.damping != 1;
  if (instance.parameters.tuned_regions[r].on) retune_modes(instance, r, by);
}

void retune_rod(Instance& instance, uint32_t rod) noexcept {
  const RodSeat& seat = instance.asset->rods.seats()[rod];
  const rods::RodBatch::JointChange change{stiffness_of(instance.parameters.rod_tunings[rod]),
                                           rod_damping_share(instance, rod)};
  // What leaves float's range keeps its last value.
  for (uint32_t k = 1; k <= seat.segment_count(); ++k)
    (void)instance.rods.batches[seat.batch].set_joint(seat.strand, k, change);
}

// ---- the way there ----

bool swings_otherwise(const PartTuning& part) noexcept {
  return moves(part.log_stiffness) || moves(part.damping);
}

// Whether anything of it will change.
bool glide_part(const InstanceState& state, float fastest_log, PartTuning& part) noexcept {
  Targets targets = targets_of(state, part);
  targets.fastest_log = fastest_log;
  bool any = false;
  for_each_number(part, targets, [&](Gliding& number, float target, float fastest) {
    glide(target, kRounding, fastest, number);
    any |= moves(number);
  });
  if (!targets.enabled && stands_at(part.intensity, 0)) part.off = kOff;
  return any;
}

void glide_regions(Instance& instance) noexcept {
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    PartTuning& part = instance.parameters.region_tunings[r];
    const bool glides = glide_part(*instance.state, kFastestOfRegion, part);
    // In the tick after it has arrived, too.
    if (swings_otherwise(part) || instance.parameters.tuned_regions[r].stiffens != stiffens(part))
      retune_region(instance, r);
    if (!glides) continue;
    instance.state->parameters.moves = 1;
    instance.tissue.quiet_ticks[r] = 0;
  }
}

void glide_rods(Instance& instance) noexcept {
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod) {
    PartTuning& part = instance.parameters.rod_tunings[rod];
    if (!glide_part(*instance.state, kFastestOfRod, part)) continue;
    instance.state->parameters.moves = 1;
    wake_rods(instance);
    if (swings_otherwise(part)) retune_rod(instance, rod);
  }
}

// A tail may still be further out than the baked limit.
bool blends(const InstanceState& state) noexcept {
  return !frame::is_simulated(state.tier) || state.blend_ticks < kBlendInTicks;
}

// ---- off and on ----

bool returns(const InstanceState& state, const PartTuning& part) noexcept {
  return part.off == kOff && targets_of(state, part).enabled;
}

void return_regions(Instance& instance) noexcept {
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    PartTuning& part = instance.parameters.region_tunings[r];
    if (!returns(*instance.state, part)) continue;
    part.off = 0;
    if (instance.level->leaves_out(r)) continue;
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    std::copy_n(instance.tissue.u[0] + size_t{3} * region.first_node, size_t{3} * region.node_count,
                instance.tissue.u[1] + size_t{3} * region.first_node);
    instance.transition.regained[r] = kRegainedNow;
    wake_regions(instance);
  }
}

void return_rods(Instance& instance) noexcept {
  const bool stood = rods_are_off(instance);  // none was followed meanwhile
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod) {
    PartTuning& part = instance.parameters.rod_tunings[rod];
    if (!returns(*instance.state, part)) continue;
    part.off = kReturns;
    instance.rods.begin_as_shown |= stood;
    wake_rods(instance);
  }
}

}  // namespace

bool notice_parameters(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const bool begins = !tunes_parts(instance);
  if (begins && all_are_as_baked(instance)) return false;
  if (begins) {
    state.parameters.tuned |= kTunedParts;
    retune_all(instance);
  }
  state.parameters.moves = 1;
  wake(instance);
  return begins;
}

void begin_tuned_tick(Instance& instance) noexcept {
  if (instance.state->parameters.tuned & kTunedAir) begin_air_tick(instance);
  if (!tunes_parts(instance)) return;
  for_each_tuning(instance, [](PartTuning& part) {
    for_each_number(part, {}, [](Gliding& number, float, float) { number.now = number.next; });
  });
  return_regions(instance);
  return_rods(instance);
}

void end_tuned_tick(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  state.parameters.moves = 0;
  if (state.parameters.tuned & kTunedAir) end_air_tick(instance);
  if (!tunes_parts(instance)) return;
  glide_regions(instance);
  glide_rods(instance);
  if (state.parameters.moves == 0 && !blends(state) && all_are_as_baked(instance))
    state.parameters.tuned &= static_cast<uint16_t>(~kTunedParts);
}

void settle_tuning(Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  if (state.parameters.tuned & kTunedAir) settle_air(instance);
  if (!tunes_parts(instance)) return;
  for_each_tuning(instance, [&](PartTuning& part) {
    const Targets targets = targets_of(state, part);
    for_each_number(part, targets, [](Gliding& number, float target, float) {
      number = {target, target, 0};
    });
    part.off = targets.enabled ? 0 : kOff;
  });
  retune_all(instance);
}

void retune_all(Instance& instance) noexcept {
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) retune_region(instance, r);
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod) retune_rod(instance, rod);
}

bool all_is_off(const Instance& instance) noexcept {
  if (!tunes_parts(instance)) return false;
  bool off = true;
  for_each_tuning(instance, [&](const PartTuning& part) {
    off = off && part.off == kOff && !returns(*instance.state, part);
  });
  return off;
}

float tuned_reach_m(const Instance& instance) noexcept {
  float most_m = 0;
  for (size_t r = 0; tunes_parts(instance) && r < instance.level->pack.regions.size(); ++r) {
    const PartTuning& part = instance.parameters.region_tunings[r];
    const Targets targets = targets_of(*instance.state, part);
    const float shows =
        std::max({1.0f, part.intensity.now, targets.intensity}) *
        std::max({1.0f, displacement_of(part, 0), targets.root_displacement * targets.root_displacement});
    const float limit_m = instance.level->pack.regions[r].displacement_limit_m,
                bound_m = displacement_bound_m(*instance.asset, r);
    // Beyond what Asset::reach_m counts: the limit, and what contacts push.
    const float more_m = std::min((shows + 1) * limit_m, bound_m) - std::min(2 * limit_m, bound_m);
    most_m = std::max(most_m, static_cast<float>(instance.asset->soft.most_shared[r]) * more_m);
  }
  return most_m;
}

}  // namespace sinew::world
