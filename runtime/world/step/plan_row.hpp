// plan_row.hpp  What a step's plan and report ask of each instance, a cache line each, and the plan's
// answers.
//
// After a step of hundreds hardly anything of an instance is in a cache, and a plan that looked at each would
// wait for memory at each. So whoever changed one last copies here what the next plan asks of it: the task
// that stepped it, the call that set something, the plan where it passes one over. A task takes the answer
// over.
#pragma once
#include "character/instance.hpp"
#include "schedule/tier_decision.hpp"

namespace sinew::world {

struct alignas(64) PlanRow {
  // As long as the instance lives: they are looked at while its task writes the rest.
  Asset* asset = nullptr;  // null: the slot is free
  InstanceState* state = nullptr;
  // Of InstanceState, Instance and their parts, under the same names:
  double remainder_s = 0;
  float importance = 1, excitation = 1;
  float waited_s = 0, held_s = 0, turn_left_s = 0;
  float cost_factor = 1;
  Tier tier : 8 = Tier::kSkinning;
  uint8_t level = 0, dormant = 0;
  bool restarting : 1 = false, hidden : 1 = false, hidden_by_caller : 1 = false, displaced : 1 = false;
  bool falls_back : 1 = false;   // the network is not to be had
  bool was_cut : 1 = false;      // cut or held
  bool shows : 1 = false;        // some of a displacement, be it zero
  bool seen : 1 = true;          // in this step (world/step/look.hpp)
  bool has_surface : 1 = false;  // stays
  bool scaled : 1 = false;       // its time runs slower or faster than the world's
  bool skips_pose : 1 = false, waited_for_pose : 1 = false;  // world/step/skip_pose.hpp
  uint8_t blind_looks : 2 = 0;  // in a row, as many as hide (world/step/look.hpp) at most
  uint8_t missed : 2 = 0;       // ticks that it would make up for (character/transition/catch_up.hpp)
  bool all_off : 1 = false;     // nothing of it is to be simulated (character/parameters/tuning.hpp)
  bool modal_at_best : 1 = false, skinned_at_best : 1 = false;  // character/tier_limit.hpp
  uint16_t regions_asleep = 0;
  float size = 1;  // in this step: share of a view's height
  uint32_t hidden_ticks =
      0;  // ahead of the state's, as is remainder_s, while hidden (character/rest/hidden.hpp)
};
static_assert(sizeof(PlanRow) == 64 && kCaughtUpTicks < 4);

inline TierCosts& costs_of(const PlanRow& row) noexcept {
  return row.has_surface ? row.asset->surface_costs : row.asset->costs;
}

struct PlanAnswer {
  frame::TierDecision decision;
  float turn_left_s = 0;  // of InstanceState
  bool idle = false;      // neither simulated nor displaced
};

inline constexpr uint32_t kBlindLooks = 3;  // in a row hide (world/step/look.hpp)

// All but what stays and what a look finds.
void copy_to_row(const Instance& instance, PlanRow* row) noexcept;

// ---- of one that is hidden (character/rest/hidden.hpp) ----

// A step in which it is hidden.
void pass_by(const frame::TickPlan& ticks, PlanRow& row) noexcept;
// To its state, before anything else reads or writes that.
void keep_hidden_ticks(const PlanRow& row) noexcept;
}  // namespace sinew::world
