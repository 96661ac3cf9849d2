// world_state.cpp  The tables' memory.
#include "world/world_state.hpp"

#include <new>

namespace sinew::world {
namespace {

template <class T>
bool take(std::unique_ptr<T[]>& to, size_t count) noexcept {
  to.reset(new (std::nothrow) T[count]());
  return to != nullptr;
}

}  // namespace

bool reserve(WorldState& world, const WorldDef& def) noexcept {
  const uint32_t most = def.max_instances;
  world.def = def;
  world.planning.scratch.reset(new (std::nothrow) frame::ScheduleScratch());
  const bool complete =
      world.planning.scratch && world.assets.reserve(def.max_assets) && world.instances.reserve(most) &&
      take(world.rows, most) && take(world.bounds, most) && take(world.planning.answers, most) &&
      take(world.planning.candidates, most) && take(world.order.slots, most) &&
      take(world.order.idle_slots, most) && take(world.order.idle_ns, (most + kIdleChunk - 1) / kIdleChunk) &&
      take(world.order.ranked, most) && take(world.order.rank_begins, kRanks + 1) &&
      take(world.planning.overdue, most) && take(world.planning.purchases, most) &&
      take(world.planning.open, most) && take(world.planning.standings, most) &&
      take(world.history, def.report_history) && take(world.events.ring, def.event_capacity);
  world.events.capacity = def.event_capacity;
  if (!complete) return false;
  world.planning.scratch->overdue = {world.planning.overdue.get(), most};
  world.planning.scratch->purchases = {world.planning.purchases.get(), most};
  world.planning.scratch->open = {world.planning.open.get(), most};
  world.planning.scratch->standings = {world.planning.standings.get(), most};
  return true;
}

void keep_row(WorldState& world, uint32_t slot) noexcept {
  const Instance* instance = world.instances.at(slot);
  if (!instance) {
    world.rows[slot] = PlanRow();
    return;
  }
  world.rows[slot].asset = instance->asset;
  world.rows[slot].state = instance->state;
  world.rows[slot].has_surface = instance->contacts.def.surface != nullptr;
  copy_to_row(*instance, &world.rows[slot]);
  if (world.rows[slot].modal_at_best) costs_of(*instance).limited = true;
  world.bounds[slot] = instance->bound;
}

void keep_pose_row(WorldState& world, uint32_t slot) noexcept {
  const Instance& instance = *world.instances.at(slot);
  world.rows[slot].dormant = static_cast<uint8_t>(instance.state->dormant);
  world.bounds[slot] = instance.bound;
}

}  // namespace sinew::world
