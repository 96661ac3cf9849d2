// worlds.cpp  Worlds: made, stepped, destroyed.
#include "c/worlds.hpp"

#include <atomic>
#include <new>
#include <utility>

#include "c/convert.hpp"
#include "sinew/isa.hpp"

namespace sinew::c {
namespace {

constexpr uint32_t kMostWorlds = 64;

// Who takes a slot sets `held` first, who leaves it clears `held` last; its generation is that of its world
// in between, and else 0. So nobody needs a lock.
struct Slot {
  std::atomic<uint32_t> generation = 0;
  std::atomic<HeldWorld*> held = nullptr;
};
Slot slots[kMostWorlds];
std::atomic<uint32_t> last_generation = 0;

uint32_t next_generation() noexcept {
  const uint32_t next = last_generation.fetch_add(1, std::memory_order_relaxed) + 1;
  return next ? next : next_generation();  // never 0
}

sinew_status put(std::unique_ptr<HeldWorld> made, sinew_world* out) noexcept {
  for (uint32_t i = 0; i < kMostWorlds; ++i) {
    HeldWorld* none = nullptr;
    if (!slots[i].held.compare_exchange_strong(none, made.get())) continue;
    made.release();
    *out = {i + 1, next_generation()};
    slots[i].generation.store(out->generation, std::memory_order_release);
    return SINEW_OK;
  }
  return refused(StatusCode::kOutOfCapacity, "sinew_create_world: 64 worlds live");
}

// An engine that gives no hook is told by the status alone, in debug builds too.
void ignore_fault(const char*, const char*, int, void*) noexcept {}

WorldDef to_def(const sinew_world_def& def, HeldOcclusion* occlusion) noexcept {
  WorldDef out;
  out.max_assets = def.max_assets;
  out.max_instances = def.max_instances;
  out.max_ticks_per_step = def.max_ticks_per_step;
  out.teleport = {def.teleport.distance, def.teleport.angle_rad, def.teleport.scale,
                  def.teleport.acceleration};
  out.sleep_tolerance = def.sleep_tolerance;
  out.report_history = def.report_history;
  out.event_capacity = def.event_capacity;
  out.budget_mode = static_cast<BudgetMode>(def.budget_mode);
  out.sight_rays_per_step = def.sight_rays_per_step;
  if (occlusion->functions.is_blocked) out.occlusion = occlusion;
  out.tasks = {def.tasks.enqueue, def.tasks.finish, def.tasks.context};
  out.clock = {def.clock.now_ns, def.clock.context};
  out.assert_hook = {def.assert_hook.fail ? def.assert_hook.fail : ignore_fault, def.assert_hook.context};
  out.profiler = {def.profiler.begin, def.profiler.end, def.profiler.context};
  return out;
}

}  // namespace

HeldWorld* find(sinew_world id) noexcept {
  if (id.index1 == 0 || id.index1 > kMostWorlds || id.generation == 0) return nullptr;
  const Slot& slot = slots[id.index1 - 1];
  return slot.generation.load(std::memory_order_acquire) == id.generation ? slot.held.load() : nullptr;
}

sinew_status stale_world() noexcept {
  return refused(StatusCode::kStaleId, "the world's id is null or was destroyed");
}

}  // namespace sinew::c

using namespace sinew;
using namespace sinew::c;

uint32_t sinew_version(void) { return SINEW_VERSION; }

sinew_world_def sinew_default_world_def(void) {
  const WorldDef from;
  sinew_world_def def = {};
  def.made_by = kMadeByDefault;
  def.max_assets = from.max_assets;
  def.max_instances = from.max_instances;
  def.max_ticks_per_step = from.max_ticks_per_step;
  def.teleport = {from.teleport.distance, from.teleport.angle_rad, from.teleport.scale,
                  from.teleport.acceleration};
  def.sleep_tolerance = from.sleep_tolerance;
  def.report_history = from.report_history;
  def.event_capacity = from.event_capacity;
  def.budget_mode = static_cast<sinew_budget_mode>(from.budget_mode);
  def.sight_rays_per_step = from.sight_rays_per_step;
  return def;
}

sinew_status sinew_create_world(uint32_t layout, const sinew_world_def* def, sinew_world* out) {
  if (layout != SINEW_LAYOUT)
    return refused(
        StatusCode::kUnsupported,
        "sinew_create_world: the caller was built with another version of sinew.h, or packs structs "
        "differently; build it with this library's header");
  if (!def || !out) return invalid("sinew_create_world: def or out is a null pointer");
  if (def->made_by != kMadeByDefault) return not_made("sinew_default_world_def");
  std::unique_ptr<HeldWorld> made(new (std::nothrow) HeldWorld());
  if (!made) return refused(StatusCode::kOutOfCapacity, "sinew_create_world: no memory");
  made->occlusion.functions = def->occlusion;
  const WorldDef cpp = to_def(*def, &made->occlusion);
  if (const sinew_status status = told(World::create(cpp, &made->world))) return status;
  made->contacts.reset(new (std::nothrow) std::unique_ptr<HeldContacts>[cpp.max_instances]());
  if (!made->contacts) return refused(StatusCode::kOutOfCapacity, "sinew_create_world: no memory");
  return put(std::move(made), out);
}

sinew_status sinew_destroy_world(sinew_world world) {
  HeldWorld* found = c::find(world);
  if (!found) return stale_world();
  if (found->stepping) return invalid("sinew_destroy_world: the world is inside a step");
  Slot& slot = slots[world.index1 - 1];
  uint32_t expected = world.generation;
  if (!slot.generation.compare_exchange_strong(expected, 0)) return stale_world();
  delete slot.held.exchange(nullptr);
  return SINEW_OK;
}

sinew_status sinew_set_budget_us(sinew_world world, float budget_us) {
  return on(world, [&](World& w) { return w.set_budget_us(budget_us); });
}

sinew_status sinew_set_views(sinew_world world, const sinew_view* views, uint32_t count) {
  if (count > 0 && !views) return invalid("sinew_set_views: views is a null pointer");
  View given[kMostViews];
  for (uint32_t v = 0; v < count && v < kMostViews; ++v) {
    if (views[v].made_by != kMadeByDefault) return not_made("sinew_default_view");
    given[v] = to_view(views[v]);
  }
  if (count > kMostViews) return invalid("sinew_set_views: at most 8 views");
  return on(world, [&](World& w) { return w.set_views({given, count}); });
}

sinew_status sinew_step(sinew_world world, float dt_s, sinew_frame_report* report) {
  HeldWorld* held = c::find(world);
  if (!held) return stale_world();
  if (held->stepping) {
    held->world.step(0);  // does nothing but tell the hook
    return invalid("sinew_step: the world is inside a step");
  }
  held->stepping = true;
  const FrameReport frame = held->world.step(dt_s);
  held->stepping = false;
  if (report) *report = same<sinew_frame_report>(frame);
  return SINEW_OK;
}

size_t sinew_history(sinew_world world, sinew_frame_report* out, size_t capacity) {
  const HeldWorld* held = c::find(world);
  return held && out ? held->world.history({as<FrameReport>(out), capacity}) : 0;
}

size_t sinew_take_events(sinew_world world, sinew_event* out, size_t capacity) {
  HeldWorld* held = c::find(world);
  return held && out ? held->world.take_events({as<Event>(out), capacity}) : 0;
}

uint64_t sinew_events_lost(sinew_world world) {
  const HeldWorld* held = c::find(world);
  return held ? held->world.events_lost() : 0;
}

uint32_t sinew_isa_count(void) { return static_cast<uint32_t>(available_isas().size()); }

const char* sinew_isa_name(uint32_t index) {
  return index < available_isas().size() ? available_isas()[index] : nullptr;
}

const char* sinew_active_isa(void) { return active_isa(); }

sinew_status sinew_force_isa(const char* name) { return told(force_isa(name)); }
