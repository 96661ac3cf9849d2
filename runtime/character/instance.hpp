// instance.hpp  One character in the world: its parts, each owned by a folder of character/.
//
// What is saved as bytes lies in one run from `state` on; the rest is scratch, or follows from it.
#pragma once
#include <cstddef>
#include <cstdint>

#include "character/asset/asset.hpp"
#include "character/contacts/contact_state.hpp"
#include "character/motion/pose_history.hpp"
#include "character/output/published.hpp"
#include "character/parameters/parameter_state.hpp"
#include "character/rods/rod_state.hpp"
#include "character/tissue/tissue_state.hpp"
#include "character/transition/transition_state.hpp"
#include "core/aligned_block.hpp"
#include "schedule/tick_clock.hpp"
#include "schedule/tier_decision.hpp"
#include "schedule/visibility/sight.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

// The part of the state that is not an array. Plain bytes: saved and restored as they are.
struct InstanceState {
  // What a plan does to those that it passes over comes first: kPlannedStateBytes of it.
  double remainder_s = 0;  // schedule/tick_clock.hpp
  float importance = 1;
  float excitation = 1;                             // character/motion/excitation.hpp
  float waited_s = 0, held_s = 0, turn_left_s = 0;  // schedule/scheduler.hpp
  Tier tier = Tier::kSkinning;                      // in the last step
  uint32_t level = 0;                         // of control graphs (character/transition/change_level.hpp)
  uint32_t restarting = 0;                    // fading out after a guard: not simulated until faded
  uint32_t fallback_ticks = 0;                // left until the network may be tried again
  uint32_t dormant = 0;                       // character/rest/dormant.hpp
  uint32_t hidden = 0, hidden_by_caller = 0;  // character/rest/hidden.hpp
  uint32_t blind_looks = 0;                   // in a row (world/step/look.hpp)
  float blend_ticks = 0;  // of the way since simulation came back, at most kBlendInTicks; one a tick or less

  RootMotion motion;
  TeleportState teleports;
  PoseClock poses;
  TransitionClock transition;
  TissueCounters tissue;
  RodCounters rods;
  ParameterMarks parameters;
  Tier tier_limit : 16 = Tier::kNetwork;  // character/tier_limit.hpp
  Tier left_tier : 16 = Tier::kSkinning;  // character/transition/catch_up.hpp: before it was left alone
  uint32_t looked = 0;                    // world/step/look.hpp: the number of the last look at it
};
inline constexpr size_t kPlannedStateBytes = offsetof(InstanceState, motion);
static_assert(kPlannedStateBytes == 64);  // a cache line

// What the last step measured; not state.
struct InstanceTimes {
  uint64_t drive_ns = 0, tissue_ns = 0, rods_ns = 0, publish_ns = 0, total_ns = 0;
  uint64_t between_ns = 0;  // of publish_ns: a provisional step (character/output/between_ticks.hpp)
};

// What the last tick tells of rods and of what was touched; not state.
struct TickTold {
  uint32_t rod_iterations = 0;  // of all solvers
  float rod_residual = 0;       // of the rod that has most
  uint32_t rod_contacts = 0;
  uint32_t vertices = 0;  // touched, or pushed out
  uint32_t refused = 0;   // the source's answers that were none
  uint32_t dropped = 0;   // contacts there was no room for
  float volume_m3 = 0;    // that contacts took from the soft parts
  float deepest_m = 0;    // that a vertex is left inside
  uint32_t touches = 0;   // in ContactState::touches
};

// What a step does with an instance: taken over from the plan's answer as its task begins, and of those that
// are passed over set by the plan.
struct InstancePlan {
  frame::TierDecision decision;
  frame::TickPlan ticks;
  double dt_s = 0;  // of its own time (World::set_time_scale)
};

// What became of an instance in the last step; not state.
struct StepMarks {
  bool came_back = false;
  bool cut = false, restarted = false, fell_back = false;
  bool held = false;                            // shown as it was, for the deadline
  bool displaced = false;                       // published displacement is not zero everywhere
  bool passed = false;                          // not stepped, dormant or waiting for a pose
  bool entered = false;                         // simulation began anew, which costs more than to go on
  bool changed_level = false, refined = false;  // the latter: to a finer one
  bool level_raised = false;                    // its nodes' past poses are not known
  uint8_t events = 0;                           // a bit for each EventKind (character/output/events.hpp)
  uint8_t made_up = 0;                          // missed ticks that were simulated after all
};

struct Instance {
  // What a plan does to those that it passes over, and what a report asks, comes first: kPlannedBytes of it.
  InstanceState* state = nullptr;
  Asset* asset = nullptr;
  frame::Ball bound;      // character/motion/pose_bound.hpp
  float cost_factor = 1;  // what its ticks take as a multiple of its asset's, smoothed; not state
  StepMarks marks;
  InstancePlan plan;

  InstanceTimes times;
  TickTold told;
  core::AlignedBlock memory;
  size_t state_bytes = 0;
  AssetId asset_id;
  InstanceDef def;  // what it was made by, as the caller gave it; not of what set_* has changed since
  const GraphLevel* level = nullptr;  // of the asset: state->level

  PoseHistory motion;
  TissueState tissue;
  RodState rods;
  ContactState contacts;
  TransitionState transition;
  ParameterState parameters;
  Published published;
};

inline constexpr size_t kPlannedBytes = offsetof(Instance, times) + offsetof(InstanceTimes, between_ns);
static_assert(kPlannedBytes <= 176);  // three cache lines with what the table of instances has before it

inline TierCosts& costs_of(const Instance& instance) noexcept {
  return instance.contacts.def.surface ? instance.asset->surface_costs : instance.asset->costs;
}

// Points joints_before, joints and next_joints, and the level, to what the state says.
void point_to_state(Instance& instance) noexcept;

}  // namespace sinew::world
