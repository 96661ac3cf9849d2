// create_instance.cpp  An instance in its bind pose, at rest.
#include "character/life/create_instance.hpp"

#include <algorithm>
#include <memory>
#include <new>

#include "character/asset/rod_batches.hpp"
#include "character/life/lay_out.hpp"
#include "character/motion/pose_bound.hpp"
#include "character/output/publish.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/rods/rod_blend.hpp"
#include "character/rods/rod_contacts.hpp"
#include "core/status.hpp"
#include "schedule/scheduler.hpp"

namespace sinew::world {
namespace {

Status scale_sources(const Asset& asset, Instance& instance) noexcept {
  const size_t probes = std::max(kProbesAtOnce, asset.rods.slot_count);
  ContactSource** const given[] = {&instance.contacts.def.source, &instance.contacts.def.surface};
  for (int k = 0; k < 2; ++k) {
    if (!*given[k]) continue;
    instance.contacts.scaled[k].reset(new (std::nothrow) ScaledSource(*given[k], probes));
    if (!instance.contacts.scaled[k] || !instance.contacts.scaled[k]->is_complete())
      return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for its contacts");
    *given[k] = instance.contacts.scaled[k].get();
  }
  return {};
}

}  // namespace

size_t instance_bytes(const Asset& asset) noexcept {
  core::Arena measure;
  Instance unused;
  lay_out(asset, measure, unused);
  return measure.used_bytes() + rod_batch_bytes(asset);
}

Status make_instance(Asset& asset, const InstanceDef& def, Instance* out) noexcept {
  if (Status status = check_rod_start(asset, def); !status.ok()) return status;
  core::Arena measure;
  Instance made;
  made.contacts.def = def.contacts;
  made.rods.start = def.rod_start;
  made.contacts.def.own_body &= !asset.pack.proxies.empty() && (asset.rods.rod_count > 0 || asset.touchable);
  if (asset.rods.rod_count == 0) made.contacts.def.surface = nullptr;
  if (Status status = scale_sources(asset, made); !status.ok()) return status;
  for (uint32_t l = 0; soft_parts_touch(asset, made.contacts.def) && l < asset.level_count; ++l) {
    GraphLevel& level = asset.levels[l];
    if (level.patches.first) continue;
    if (Status status = make_surface_patches(level.pack, &level.patches); !status.ok()) return status;
  }
  lay_out(asset, measure, made);
  const size_t bytes = measure.used_bytes();
  made.memory = core::AlignedBlock(bytes);
  if (!made.memory.data()) {
    return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for %zu bytes", bytes);
  }
  if (Status status = make_rod_batches(asset, def, &made.rods.batches); !status.ok()) return status;
  core::Arena arena(made.memory.data());
  lay_out(asset, arena, made);
  made.asset = &asset;
  made.asset_id = def.asset;
  made.def = def;
  new (made.state) InstanceState();
  begin(asset, made.parameters);
  point_to_state(made);
  made.state->motion.root = def.root;
  made.state->importance = frame::sane_importance(def.importance);
  bind_pose(asset.pack.joints, made.motion.joints);
  std::copy_n(made.motion.joints, asset.pack.character->joint_count, made.motion.joints_older);
  std::copy_n(made.motion.joints, asset.pack.character->joint_count, made.motion.joints_before);
  std::copy_n(made.motion.joints, asset.pack.character->joint_count, made.motion.next_joints);
  bound_pose(made);
  forget_rods(made);
  if (Status status = make_rod_colliders(made); !status.ok()) return status;
  publish(made);
  *out = std::move(made);
  return {};
}

}  // namespace sinew::world
