// world_state.hpp  What a World holds.
#pragma once
#include <limits>
#include <memory>
#include <span>

#include "character/asset/asset.hpp"
#include "character/instance.hpp"
#include "character/output/events.hpp"
#include "character/tick.hpp"
#include "core/bring_near.hpp"
#include "core/slot_table.hpp"
#include "schedule/candidate.hpp"
#include "schedule/cost_model.hpp"
#include "schedule/visibility/sight.hpp"
#include "sinew/types.hpp"
#include "world/step/plan_row.hpp"

namespace sinew::world {

inline constexpr uint32_t kIdleChunk = 64;  // idle instances in one task
inline constexpr uint32_t kRanks = 1024;    // of weights, a quarter of an octave each

// Of what is not idle: how many ranks are before its own.
struct Ranked {
  uint32_t slot, behind;
};

// What a plan works in, and its answers: [max_instances] each.
struct PlanMemory {
  std::unique_ptr<PlanAnswer[]> answers;           // by slot
  std::unique_ptr<frame::Candidate[]> candidates;  // of all that are visible, by slot
  // The scheduler's.
  std::unique_ptr<frame::Overdue[]> overdue;
  std::unique_ptr<frame::Purchase[]> purchases;
  std::unique_ptr<uint32_t[]> open;
  std::unique_ptr<frame::Standing[]> standings;
  std::unique_ptr<frame::ScheduleScratch> scratch;
};

// In which order a step's instances run, and what of it came to an end: [max_instances] unless said
// otherwise.
struct StepOrder {
  std::unique_ptr<uint32_t[]> slots;  // of what is not idle, in the order in which they run
  std::unique_ptr<uint32_t[]> idle_slots;
  std::unique_ptr<uint64_t[]> idle_ns;  // [chunks] of idle instances: what they took
  std::unique_ptr<Ranked[]> ranked;
  std::unique_ptr<uint32_t[]> rank_begins;  // [kRanks + 1]
  std::span<uint32_t> running;              // of slots
  float undone_us = 0;                      // that was planned for what was cut
  uint64_t busy_ns = 0;                     // of all instances that were in order
  uint32_t idle_count = 0;
};

// What steps have taken.
struct StepCosts {
  frame::Capacity capacity;
  frame::CostEstimate idle{0.2f};     // of one idle instance
  frame::CostEstimate overhead{10};   // of a step: scheduling and reports
  frame::CostEstimate reporting{5};   // the latter's part
  frame::CostEstimate between{0.2f};  // from one instance's end to the next one's begin, on one thread
};

// What the engine shows, and who was looked at.
struct Looks {
  frame::Sight sights[kMostViews];
  uint32_t sight_count = 0;
  uint32_t last_look = 0;  // slot of the instance that was looked at last
  uint32_t looks = 0;      // how many there were
};

struct WorldState {
  WorldDef def;
  core::SlotTable<Asset, AssetId> assets;
  core::SlotTable<Instance, InstanceId> instances;
  // [max_instances], by slot: what plans ask of instances, and where they are.
  std::unique_ptr<PlanRow[]> rows;
  std::unique_ptr<frame::Ball[]> bounds;
  PlanMemory planning;
  StepOrder order;
  StepCosts costs;
  Looks views;
  double dt_s = 0;
  uint32_t ticks = 0;   // the most that one has
  float dropped_s = 0;  // likewise
  TickContext context;  // of the step that runs
  EventLog events;
  std::unique_ptr<FrameReport[]> history;  // [def.report_history], the last at frames - 1 modulo that
  float budget_us = std::numeric_limits<float>::infinity();
  Environment environment;
  bool restored = false;  // an instance was, since the last step
  uint64_t frames = 0;
  uint32_t rejected_poses = 0;  // since the last step
  bool stepping = false;
};

// Calls work(row, slot) for each instance, in the slots' order.
template <class Work>
void for_each_row(const WorldState& world, Work work) noexcept {
  for (uint32_t slot = 0; slot < world.instances.end(); ++slot)
    if (PlanRow& row = world.rows[slot]; row.asset) work(row, slot);
}

// Hardly anything of an instance is in a cache when a step or its tasks are over: what is wanted of those
// that come next comes in while others are worked on.
inline void bring_instance_near(const WorldState& world, uint32_t slot) noexcept {
  world.instances.bring_near(slot, kPlannedBytes);
  core::bring_near(world.rows[slot].state, kPlannedStateBytes);
}

inline frame::TickPlans tick_plans(const WorldState& world) noexcept {
  return {world.dt_s, world.def.max_ticks_per_step};
}

// Rows are kept as the instances are: after whatever changed one.
void keep_row(WorldState& world, uint32_t slot) noexcept;
// Likewise after a pose was set, which wakes.
void keep_pose_row(WorldState& world, uint32_t slot) noexcept;

// The tables' memory. False: there is none.
bool reserve(WorldState& world, const WorldDef& def) noexcept;

}  // namespace sinew::world
