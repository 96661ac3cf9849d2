// world_state.hpp  What a World holds.
#pragma once
#include <limits>
#include <memory>
#include <span>

#include "core/bring_near.hpp"
#include "core/slot_table.hpp"
#include "frame/cost_model.hpp"
#include "frame/scheduler.hpp"
#include "frame/sight.hpp"
#include "sinew/types.hpp"
#include "world/asset.hpp"
#include "world/instance.hpp"
#include "world/tick.hpp"

namespace sinew::world {

inline constexpr uint32_t kIdleChunk = 64;  // idle instances in one task
inline constexpr uint32_t kRanks = 1024;    // of weights, a quarter of an octave each

// Of what is not idle: how many ranks are before its own.
struct Ranked {
  uint32_t slot, behind;
};

struct WorldState {
  WorldDef def;
  core::SlotTable<Asset, AssetId> assets;
  core::SlotTable<Instance, InstanceId> instances;
  // Of a step, [max_instances] unless said otherwise.
  std::unique_ptr<frame::Candidate[]> candidates;  // of all that are visible, by slot
  std::unique_ptr<uint32_t[]> order;  // slots of what is not idle, in the order in which they run
  std::unique_ptr<uint32_t[]> idle_slots;
  std::unique_ptr<uint64_t[]> idle_ns;  // [chunks] of idle instances: what they took
  std::unique_ptr<Ranked[]> ranked;
  std::unique_ptr<uint32_t[]> rank_begins;  // [kRanks + 1]
  std::unique_ptr<uint32_t[]> overdue;
  std::unique_ptr<frame::Purchase[]> purchases;
  std::unique_ptr<frame::ScheduleScratch> scratch;
  std::span<uint32_t> running;  // of order
  float undone_us = 0;          // that was planned for what was cut
  uint32_t idle_count = 0;
  TickContext context;  // of the step that runs
  frame::Capacity capacity;
  frame::CostEstimate idle{0.2f};          // of one idle instance
  frame::CostEstimate overhead{10};        // of a step: scheduling and reports
  frame::CostEstimate reporting{5};        // the latter's part
  std::unique_ptr<FrameReport[]> history;  // [def.report_history], the last at frames - 1 modulo that
  float budget_us = std::numeric_limits<float>::infinity();
  frame::Sight sights[kMostViews];
  uint32_t sight_count = 0;
  uint32_t next_look = 0;  // slot of the instance that was looked at last
  uint64_t frames = 0;
  uint32_t rejected_poses = 0;  // since the last step
  bool stepping = false;
};

// Calls work(instance, slot) for each, in the slots' order. After a step of all of them hardly anything of an
// instance is in a cache: what is looked at here comes in while those before it are worked on.
template <class Work>
void for_each_instance(const WorldState& world, Work work) noexcept {
  constexpr uint32_t kFar = 12, kNear = 6;
  for (uint32_t slot = 0; slot < world.instances.end(); ++slot) {
    world.instances.bring_near(slot + kFar, kPlannedBytes);
    if (slot + kNear < world.instances.end())
      if (const Instance* ahead = world.instances.at(slot + kNear))
        core::bring_near(ahead->state, kPlannedStateBytes);
    if (Instance* instance = world.instances.at(slot)) work(*instance, slot);
  }
}

// The tables' memory. False: there is none.
bool reserve(WorldState& world, const WorldDef& def) noexcept;

}  // namespace sinew::world
