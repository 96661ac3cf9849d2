// worlds.hpp  Worlds behind ids, with what the C interface keeps beside each.
#pragma once
#include <memory>

#include "c/refusal.hpp"
#include "c/sources.hpp"
#include "sinew/world.hpp"

namespace sinew::c {

struct HeldWorld {
  World world;
  HeldOcclusion occlusion;
  std::unique_ptr<std::unique_ptr<HeldContacts>[]> contacts;  // [max_instances], by slot; null: it has none
  bool stepping = false;
};

// Null for an id that is null or whose world is gone.
HeldWorld* find(sinew_world id) noexcept;
sinew_status stale_world() noexcept;

// What call(world) answers, or that there is no such world.
template <class Call>
sinew_status on(sinew_world id, Call call) noexcept {
  HeldWorld* held = find(id);
  return held ? told(call(held->world)) : stale_world();
}

inline AssetId to_id(sinew_asset id) noexcept { return {id.index1, id.generation}; }
inline InstanceId to_id(sinew_instance id) noexcept { return {id.index1, id.generation}; }

}  // namespace sinew::c
