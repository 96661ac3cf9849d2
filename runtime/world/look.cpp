// look.cpp  see look.hpp.
#include "world/look.hpp"

#include <algorithm>
#include <span>

namespace sinew::world {
namespace {

std::span<const frame::Sight> sights_of(const WorldState& world) noexcept {
  return {world.sights, world.sight_count};
}

float size_of(const WorldState& world, const Instance& instance) noexcept {
  if (world.sight_count == 0) return 1;
  float size = 0;
  for (const frame::Sight& sight : sights_of(world))
    size = std::max(size, frame::seen_size(sight, instance.bound));
  return size;
}

// Whether any of this look's rays gets through.
bool gets_through(WorldState& world, const Instance& instance, const frame::Sight& sight) noexcept {
  const frame::Ball& ball = instance.bound;
  const float size = frame::seen_size(sight, ball);
  if (size == 0 || size == 1) return size == 1;  // not in this view; so near that nothing is between
  for (uint32_t ray = 0; ray < kRaysALook; ++ray) {
    double point_m[3];
    frame::point_on(sight, ball, instance.state->blind_looks * kRaysALook + ray, point_m);
    if (!world.def.occlusion->is_blocked(sight.eye_m, point_m)) return true;
  }
  return false;
}

void look_at(WorldState& world, Instance& instance) noexcept {
  uint32_t& blind = instance.state->blind_looks;
  const bool seen = std::ranges::any_of(
      sights_of(world), [&](const frame::Sight& sight) { return gets_through(world, instance, sight); });
  blind = seen ? 0 : blind + 1;
}

// A few of those in view, where the last step left off.
void look_behind_things(WorldState& world) noexcept {
  if (!world.def.occlusion || world.sight_count == 0) return;
  const uint32_t end = world.instances.end();
  uint32_t rays = world.def.sight_rays_per_step;
  for (uint32_t passed = 0; passed < end && rays >= kRaysALook; ++passed) {
    world.next_look = world.next_look + 1 < end ? world.next_look + 1 : 0;
    Instance* instance = world.instances.at(world.next_look);
    if (!instance || instance->size == 0 || instance->state->hidden_by_caller) continue;
    look_at(world, *instance);
    rays -= std::min(rays, kRaysALook * world.sight_count);
  }
}

}  // namespace

void look(WorldState& world) noexcept {
  const bool looks =
      world.def.occlusion && world.sight_count > 0 && world.def.sight_rays_per_step >= kRaysALook;
  const auto decide = [](Instance& instance, uint32_t) {
    const InstanceState& state = *instance.state;
    instance.seen = !state.hidden_by_caller && instance.size > 0 && state.blind_looks < kBlindLooks;
  };
  for_each_instance(world, [&](Instance& instance, uint32_t slot) {
    instance.size = size_of(world, instance);
    // Comes into view as seen, and nothing is hidden by what was once in front of it.
    if (!looks || instance.size == 0 || instance.state->hidden_by_caller) instance.state->blind_looks = 0;
    decide(instance, slot);
  });
  if (!looks) return;
  look_behind_things(world);
  for_each_instance(world, decide);
}

}  // namespace sinew::world
