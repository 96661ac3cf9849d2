// world_impl.hpp  What the public API's functions begin with: the object behind an id, and whether it may be
// had.
#pragma once
#include "core/assert_hook.hpp"
#include "core/status.hpp"
#include "sinew/world.hpp"
#include "world/world_state.hpp"

namespace sinew {

struct World::Impl : world::WorldState {};

namespace world {

inline Status invalid(const char* line) noexcept {
  return core::make_status(StatusCode::kInvalidArgument, "%s", line);
}
inline Status null_world() noexcept { return invalid("this World is null; make one with World::create"); }
inline Status refuse_busy() noexcept { return invalid("the world is inside a step"); }

// The object behind an id; else a programmer error at the hook, and a Status.
template <class T, class Id>
Status find(const core::SlotTable<T, Id>& table, Id id, const AssertHook& hook, const char* what,
            T** out) noexcept {
  *out = table.find(id);
  if (*out) return {};
  core::report_fault(hook, what);
  return core::make_status(StatusCode::kStaleId, "%s (index %u, generation %u)", what, id.index1,
                           id.generation);
}

inline Status find_asset(const WorldState* state, AssetId id, Asset** out) noexcept {
  if (!state) return null_world();
  return find(state->assets, id, state->def.assert_hook, "the asset's id is null or was unloaded", out);
}

inline Status find_instance(const WorldState* state, InstanceId id, Instance** out) noexcept {
  if (!state) return null_world();
  return find(state->instances, id, state->def.assert_hook, "the instance's id is null or was destroyed",
              out);
}

// Whose state is written, or read whole; within a step, which its callers refuse, nothing of it is touched.
inline Status find_state(const WorldState* state, InstanceId id, Instance** out) noexcept {
  Status status = find_instance(state, id, out);
  if (status.ok() && !state->stepping) keep_hidden_ticks(state->rows[id.index1 - 1]);
  return status;
}

// A world's objects may not be made or unmade, nor a step begun, while its tasks run.
inline bool busy(const WorldState& state) noexcept {
  if (state.stepping) core::report_fault(state.def.assert_hook, "the world is inside a step");
  return state.stepping;
}

}  // namespace world
}  // namespace sinew
