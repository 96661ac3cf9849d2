// world_state.hpp  What a World holds.
#pragma once
#include <limits>
#include <memory>

#include "core/slot_table.hpp"
#include "frame/cost_model.hpp"
#include "frame/scheduler.hpp"
#include "frame/sight.hpp"
#include "sinew/types.hpp"
#include "world/asset.hpp"
#include "world/instance.hpp"
#include "world/tick.hpp"

namespace sinew::world {

struct WorldState {
  WorldDef def;
  core::SlotTable<Asset, AssetId> assets;
  core::SlotTable<Instance, InstanceId> instances;
  std::unique_ptr<frame::Candidate[]> candidates;  // [max_instances], in running order once scheduled
  TickContext context;                             // of the step that runs
  frame::Capacity capacity;
  float budget_us = std::numeric_limits<float>::infinity();
  frame::Sight sights[kMostViews];
  uint32_t sight_count = 0;
  uint32_t next_look = 0;  // slot of the instance that was looked at last
  uint64_t frames = 0;
  uint32_t rejected_poses = 0;  // since the last step
  bool stepping = false;
};

}  // namespace sinew::world
