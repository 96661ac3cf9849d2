// describe_instance.cpp  see describe_instance.hpp.
#include "character/describe_instance.hpp"

#include "character/rest/asleep.hpp"
#include "character/rods/rod_contacts.hpp"
#include "character/transition/shares.hpp"
#include "core/clock.hpp"
#include "schedule/candidate.hpp"

namespace sinew::world {
namespace {

TierReason reason_of(const Instance& instance, uint32_t asleep) noexcept {
  const InstanceState& state = *instance.state;
  if (state.hidden) return TierReason::kHidden;
  if (instance.marks.cut || instance.marks.held) return TierReason::kCut;
  if (state.restarting || state.fallback_ticks > 0) return TierReason::kGuard;
  const GraphLevel& level = *instance.level;
  if (frame::is_simulated(state.tier) && asleep + level.regions_left_out() == level.pack.regions.size())
    return TierReason::kStill;
  const bool overdue = !frame::is_simulated(state.tier) && state.waited_s > frame::kLongestWait_s;
  return overdue ? TierReason::kWaiting : instance.plan.decision.why;
}

}  // namespace

InstanceReport describe(const Instance& instance, InstanceId id) noexcept {
  const InstanceState& state = *instance.state;
  const float blend = shown_share(instance);
  const bool simulated = frame::is_simulated(state.tier);
  const uint32_t asleep = simulated ? regions_asleep(instance) : 0;
  const auto scale = static_cast<float>(state.motion.root.scale);
  return {.instance = id,
          .tier = simulated || blend > 0 ? state.tier : Tier::kSkinning,
          .why = reason_of(instance, asleep),
          .error = state.hidden ? 1 : error_of(*instance.asset, state.tier, state.level),
          .graph_level = state.level,
          .blend = blend,
          .ticks_since_network = state.tissue.ticks_since_network,
          .input_clamps = state.tissue.input_clamps,
          .displacement_clamps = state.tissue.displacement_clamps,
          .fallbacks = state.tissue.fallbacks,
          .restarts = state.tissue.restarts,
          .regions_asleep = asleep,
          .regions_left_out = simulated ? instance.level->regions_left_out() : 0,
          .teleports = state.teleports.root_teleports,
          .part_teleports = state.teleports.part_teleports,
          .rod_recoveries = state.rods.recoveries,
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
          .planned_us = state.hidden ? 0 : instance.plan.decision.cost_us,
          .hidden = state.hidden != 0,
          .dormant = state.dormant != 0};
}

}  // namespace sinew::world
