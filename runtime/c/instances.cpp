// instances.cpp  Instances: made, posed, changed, saved.
#include <new>

#include "c/convert.hpp"
#include "c/worlds.hpp"

using namespace sinew;
using namespace sinew::c;

namespace {

bool are_same(const sinew_contact_source& a, const sinew_contact_source& b) noexcept {
  return a.find == b.find && a.push == b.push && a.context == b.context;
}

InstanceDef to_def(const sinew_instance_def& def, HeldContacts* held) noexcept {
  InstanceDef out;
  out.asset = to_id(def.asset);
  out.importance = def.importance;
  out.root = to_root(def.root);
  if (def.contacts.find) out.contacts.source = &held->source;
  if (def.surface.find)
    out.contacts.surface = are_same(def.surface, def.contacts) ? out.contacts.source : &held->surface;
  out.contacts.owner = def.contact_owner;
  out.contacts.tissue = def.tissue_touches;
  out.contacts.rods = def.rods_touch;
  out.contacts.own_body = def.touches_own_body;
  out.rod_start = static_cast<RodWarmStart>(def.rod_start);
  out.max_rod_iterations = def.max_rod_iterations;
  out.report_rod_residual = def.report_rod_residual;
  return out;
}

}  // namespace

sinew_instance_def sinew_default_instance_def(void) {
  const InstanceDef from;
  sinew_instance_def def = {};
  def.made_by = kMadeByDefault;
  def.importance = from.importance;
  def.root = same<sinew_root>(from.root);
  def.tissue_touches = from.contacts.tissue;
  def.rods_touch = from.contacts.rods;
  def.touches_own_body = from.contacts.own_body;
  def.rod_start = static_cast<sinew_rod_start>(from.rod_start);
  def.max_rod_iterations = from.max_rod_iterations;
  def.report_rod_residual = from.report_rod_residual;
  return def;
}

sinew_pose sinew_default_pose(void) {
  const Pose from;
  sinew_pose pose = {};
  pose.made_by = kMadeByDefault;
  pose.root = same<sinew_root>(from.root);
  pose.space = same<sinew_root>(from.space.root);
  return pose;
}

sinew_view sinew_default_view(void) {
  const View from;
  sinew_view view = {};
  view.made_by = kMadeByDefault;
  std::copy_n(from.rotation_xyzw, 4, view.rotation_xyzw);
  view.height_rad = from.height_rad;
  view.aspect = from.aspect;
  view.far_m = from.far_m;
  return view;
}

sinew_status sinew_create_instance(sinew_world world, const sinew_instance_def* def, sinew_instance* out) {
  if (!def || !out) return invalid("sinew_create_instance: def or out is a null pointer");
  if (def->made_by != kMadeByDefault) return not_made("sinew_default_instance_def");
  HeldWorld* held = c::find(world);
  if (!held) return stale_world();
  std::unique_ptr<HeldContacts> contacts;
  if (def->contacts.find || def->surface.find) {
    contacts.reset(new (std::nothrow) HeldContacts{HeldSource(def->contacts), HeldSource(def->surface)});
    if (!contacts) return refused(StatusCode::kOutOfCapacity, "sinew_create_instance: no memory");
  }
  InstanceId id;
  const Status status = held->world.create_instance(to_def(*def, contacts.get()), &id);
  if (!status.ok()) return told(status);
  held->contacts[id.index1 - 1] = std::move(contacts);
  *out = {id.index1, id.generation};
  return SINEW_OK;
}

sinew_status sinew_destroy_instance(sinew_world world, sinew_instance instance) {
  HeldWorld* held = c::find(world);
  if (!held) return stale_world();
  const sinew_status status = told(held->world.destroy_instance(to_id(instance)));
  if (status == SINEW_OK) held->contacts[instance.index1 - 1].reset();
  return status;
}

sinew_status sinew_set_pose(sinew_world world, sinew_instance instance, const sinew_pose* pose) {
  if (!pose) return invalid("sinew_set_pose: pose is a null pointer");
  if (pose->made_by != kMadeByDefault) return not_made("sinew_default_pose");
  if (!pose->joints) return invalid("sinew_set_pose: joints is a null pointer");
  const Pose given{.joints = {as<const Matrix34>(pose->joints), pose->joint_count},
                   .root = to_root(pose->root),
                   .space = {pose->space_id, to_root(pose->space)},
                   .teleport = pose->teleport};
  return on(world, [&](World& w) { return w.set_pose(to_id(instance), given); });
}

sinew_status sinew_skip_pose(sinew_world world, sinew_instance instance) {
  return on(world, [&](World& w) { return w.skip_pose(to_id(instance)); });
}

sinew_status sinew_set_importance(sinew_world world, sinew_instance instance, float importance) {
  return on(world, [&](World& w) { return w.set_importance(to_id(instance), importance); });
}

sinew_status sinew_set_hidden(sinew_world world, sinew_instance instance, bool hidden) {
  return on(world, [&](World& w) { return w.set_hidden(to_id(instance), hidden); });
}

sinew_status sinew_set_tier_limit(sinew_world world, sinew_instance instance, sinew_tier best) {
  return on(world, [&](World& w) { return w.set_tier_limit(to_id(instance), static_cast<Tier>(best)); });
}

sinew_status sinew_set_time_scale(sinew_world world, sinew_instance instance, float scale) {
  return on(world, [&](World& w) { return w.set_time_scale(to_id(instance), scale); });
}

sinew_status sinew_set_felt_root_motion(sinew_world world, sinew_instance instance, float share) {
  return on(world, [&](World& w) { return w.set_felt_root_motion(to_id(instance), share); });
}

sinew_status sinew_reset(sinew_world world, sinew_instance instance) {
  return on(world, [&](World& w) { return w.reset(to_id(instance)); });
}

sinew_status sinew_get_report(sinew_world world, sinew_instance instance, sinew_instance_report* out) {
  InstanceReport report;
  const sinew_status status =
      on(world, [&](World& w) { return w.report(to_id(instance), out ? &report : nullptr); });
  if (status == SINEW_OK) *out = same<sinew_instance_report>(report);
  return status;
}

size_t sinew_state_bytes(sinew_world world, sinew_instance instance) {
  const HeldWorld* held = c::find(world);
  return held ? held->world.state_bytes(to_id(instance)) : 0;
}

sinew_status sinew_save_state(sinew_world world, sinew_instance instance, void* out, size_t byte_count) {
  if (!out) return invalid("sinew_save_state: out is a null pointer");
  return on(world, [&](World& w) {
    return w.save_state(to_id(instance), {static_cast<std::byte*>(out), byte_count});
  });
}

sinew_status sinew_restore_state(sinew_world world, sinew_instance instance, const void* bytes,
                                 size_t byte_count) {
  if (!bytes) return invalid("sinew_restore_state: bytes is a null pointer");
  return on(world, [&](World& w) {
    return w.restore_state(to_id(instance), {static_cast<const std::byte*>(bytes), byte_count});
  });
}
