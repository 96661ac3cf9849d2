// look.cpp  see look.hpp.
#include "world/step/look.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace sinew::world {
namespace {

std::span<const frame::Sight> sights_of(const WorldState& world) noexcept {
  return {world.views.sights, world.views.sight_count};
}

constexpr uint32_t kAtOnce = 32;

void bring_near(const WorldState& world, uint32_t first, uint32_t last) noexcept {
  if (first >= last) return;
  core::bring_near(&world.rows[first], (last - first) * sizeof(PlanRow));
  core::bring_near(&world.bounds[first], (last - first) * sizeof(frame::Ball));
}

// Of the slots from `first` on.
void put_sizes(const WorldState& world, uint32_t first, std::span<float> sizes) noexcept {
  std::ranges::fill(sizes, world.views.sight_count == 0 ? 1.0f : 0.0f);
  for (const frame::Sight& sight : sights_of(world))
    frame::enlarge_seen_sizes(sight, {&world.bounds[first], sizes.size()}, sizes.data());
}

// Whether any of this look's rays gets through.
bool gets_through(WorldState& world, uint32_t slot, const frame::Sight& sight) noexcept {
  const frame::Ball& ball = world.bounds[slot];
  const float size = frame::seen_size(sight, ball);
  if (size == 0 || size == 1) return size == 1;  // not in this view; so near that nothing is between
  for (uint32_t ray = 0; ray < kRaysALook; ++ray) {
    double point_m[3];
    frame::point_on(sight, ball, world.rows[slot].state->blind_looks * kRaysALook + ray, point_m);
    if (!world.def.occlusion->is_blocked(sight.eye_m, point_m)) return true;
  }
  return false;
}

void decide(PlanRow& row) noexcept {
  row.seen = !row.hidden_by_caller & (row.size > 0) & (row.blind_looks < kBlindLooks);
}

void look_at(WorldState& world, uint32_t slot) noexcept {
  PlanRow& row = world.rows[slot];
  uint32_t& blind = row.state->blind_looks;
  const bool seen = std::ranges::any_of(
      sights_of(world), [&](const frame::Sight& sight) { return gets_through(world, slot, sight); });
  blind = seen ? 0 : blind + 1;
  row.blind_looks = std::min(blind, kBlindLooks) & 3;
  row.state->looked = ++world.views.looks;
  world.views.last_look = slot;
  decide(row);
}

// A few of those in view, where the last step left off.
void look_behind_things(WorldState& world) noexcept {
  if (!world.def.occlusion || world.views.sight_count == 0) return;
  const uint32_t end = world.instances.end();
  uint32_t rays = world.def.sight_rays_per_step;
  const uint32_t from = world.views.last_look + 1;
  for (uint32_t passed = 0; passed < end && rays >= kRaysALook; ++passed) {
    const uint32_t slot = (from + passed) % end;
    const PlanRow& row = world.rows[slot];
    if (!row.asset || row.size == 0 || row.hidden_by_caller) continue;
    look_at(world, slot);
    rays -= std::min(rays, kRaysALook * world.views.sight_count);
  }
}

// After a rollback the looks go on behind the one that was the last before the save.
void find_last_look(WorldState& world) noexcept {
  world.views.looks = 0;
  world.views.last_look = 0;
  for_each_row(world, [&](const PlanRow& row, uint32_t slot) {
    if (row.state->looked <= world.views.looks) return;
    world.views.looks = row.state->looked;
    world.views.last_look = slot;
  });
}

void forget_looks(PlanRow& row) noexcept {
  row.state->blind_looks = 0;
  row.blind_looks = 0;
}

}  // namespace

void look(WorldState& world) noexcept {
  const bool looks =
      world.def.occlusion && world.views.sight_count > 0 && world.def.sight_rays_per_step >= kRaysALook;
  const uint32_t end = world.instances.end();
  float sizes[kAtOnce];
  for (uint32_t first = 0; first < end; first += kAtOnce) {
    const uint32_t last = std::min(first + kAtOnce, end);
    bring_near(world, last, std::min(last + kAtOnce, end));
    put_sizes(world, first, {sizes, last - first});
    for (uint32_t slot = first; slot < last; ++slot) {
      PlanRow& row = world.rows[slot];
      if (!row.asset) continue;
      row.size = sizes[slot - first];
      // Comes into view as seen, and nothing is hidden by what was once in front of it.
      if (row.blind_looks > 0 && (!looks || row.size == 0 || row.hidden_by_caller)) forget_looks(row);
      decide(row);
    }
  }
  if (!looks) return;
  if (std::exchange(world.restored, false)) find_last_look(world);
  look_behind_things(world);
}

}  // namespace sinew::world
