// world.cpp  The public API: ids and arguments are checked here, work is done in the files beside. What
// assets tell: world_asset.cpp. What is read back: world_read.cpp.
#include "sinew/world.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <utility>

#include "character/asset/open_asset.hpp"
#include "character/life/create_instance.hpp"
#include "character/life/forget.hpp"
#include "character/life/replace_asset.hpp"
#include "character/life/snapshot.hpp"
#include "character/motion/pose.hpp"
#include "character/motion/pose_bound.hpp"
#include "character/output/publish.hpp"
#include "character/parameters/air.hpp"
#include "character/parameters/check_parameters.hpp"
#include "character/parameters/tuning.hpp"
#include "character/rest/asleep.hpp"
#include "character/rest/dormant.hpp"
#include "character/tier_limit.hpp"
#include "core/floating_point.hpp"
#include "core/status.hpp"
#include "kernels/isa.hpp"
#include "kernels/kernels.hpp"
#include "schedule/scheduler.hpp"
#include "world/step/step.hpp"
#include "world/world_impl.hpp"

namespace sinew {
namespace {

using core::make_status;
using world::Asset;
using world::Instance;
using world::WorldState;

using world::busy;
using world::find_asset;
using world::find_instance;
using world::find_state;
using world::invalid;
using world::null_world;
using world::refuse_busy;

Status check_def(const WorldDef& def) noexcept {
  constexpr uint32_t kMostAssets = 65535, kMostInstances = 100000, kMostTicks = 64, kMostReports = 65535;
  if (def.max_assets < 1 || def.max_assets > kMostAssets)
    return invalid("WorldDef: max_assets must be 1..65535");
  if (def.max_instances < 1 || def.max_instances > kMostInstances) {
    return invalid("WorldDef: max_instances must be 1..100000");
  }
  if (def.max_ticks_per_step < 1 || def.max_ticks_per_step > kMostTicks) {
    return invalid("WorldDef: max_ticks_per_step must be 1..64");
  }
  for (const auto& [value, name] : {std::pair{def.teleport.distance, "distance"},
                                    {def.teleport.angle_rad, "angle_rad"},
                                    {def.teleport.acceleration, "acceleration"}})
    if (!(value > 0)) return make_status(StatusCode::kInvalidArgument, "TeleportDef: %s must be > 0", name);
  if (!(def.teleport.scale > 1)) return invalid("TeleportDef: scale must be > 1");
  if (!(def.sleep_tolerance >= 0 && def.sleep_tolerance <= 1))
    return invalid("WorldDef: sleep_tolerance must be 0..1, a fraction of a region's radius");
  if (def.report_history > kMostReports) return invalid("WorldDef: report_history must be 0..65535");
  if (def.event_capacity > kMostReports) return invalid("WorldDef: event_capacity must be 0..65535");
  if (!def.profiler.begin != !def.profiler.end)
    return invalid("WorldDef: of profiler.begin and profiler.end one is set, the other is null");
  if (def.budget_mode != BudgetMode::kTime && def.budget_mode != BudgetMode::kWorkUnits) {
    return invalid("WorldDef: budget_mode is neither kTime nor kWorkUnits");
  }
  if (def.tasks.enqueue && !def.tasks.finish)
    return invalid("WorldDef: tasks.enqueue is set, tasks.finish is null");
  return {};
}

// After its instance was made, changed or unmade.
void keep_row(WorldState& state, InstanceId id) noexcept { world::keep_row(state, id.index1 - 1); }

}  // namespace

World::~World() { delete impl_; }
World::World(World&& other) noexcept : impl_(std::exchange(other.impl_, nullptr)) {}
World& World::operator=(World&& other) noexcept {
  World taken(std::move(other));
  std::swap(impl_, taken.impl_);
  return *this;
}

Status World::create(const WorldDef& def, World* out) noexcept {
  const core::FloatingPointScope mode;
  if (!out) return invalid("World::create: out is a null pointer");
  if (Status status = check_def(def); !status.ok()) return status;
  if (Status status = simd::check_environment(); !status.ok()) return status;
  World made;
  made.impl_ = new (std::nothrow) Impl();
  if (!made.impl_ || !world::reserve(*made.impl_, def))
    return make_status(StatusCode::kOutOfCapacity, "World::create: no memory for the tables");
  (void)simd::kernels();  // the instruction set is chosen here, not inside the first step
  *out = std::move(made);
  return {};
}

static Status add_asset(WorldState& state, Asset&& asset, AssetId* out) noexcept {
  const AssetId id = state.assets.create(std::move(asset));
  if (is_null(id)) {
    return make_status(StatusCode::kOutOfCapacity, "load_asset: max_assets (%u) are loaded",
                       state.assets.capacity());
  }
  *out = id;
  return {};
}

Status World::load_asset(std::span<const std::byte> bytes, AssetId* out) noexcept {
  const core::FloatingPointScope mode;
  if (!impl_) return null_world();
  if (!out) return invalid("load_asset: out is a null pointer");
  if (busy(*impl_)) return refuse_busy();
  Asset asset;
  if (Status status = world::open_asset(bytes, &asset); !status.ok()) return status;
  return add_asset(*impl_, std::move(asset), out);
}

Status World::load_asset_file(const char* path, AssetId* out) noexcept {
  const core::FloatingPointScope mode;
  if (!impl_) return null_world();
  if (!path || !out) return invalid("load_asset_file: path or out is a null pointer");
  if (busy(*impl_)) return refuse_busy();
  pack::MappedFile file;
  if (Status status = pack::MappedFile::open(path, &file); !status.ok()) return status;
  Asset asset;
  if (Status status = world::open_asset(file.bytes(), &asset); !status.ok()) {
    return make_status(status.code, "%.100s: %s", path, status.message);
  }
  asset.file = std::move(file);
  return add_asset(*impl_, std::move(asset), out);
}

Status World::unload_asset(AssetId id) noexcept {
  Asset* asset = nullptr;
  if (Status status = find_asset(impl_, id, &asset); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  if (asset->live_instances > 0) {
    return make_status(StatusCode::kInvalidArgument, "unload_asset: %u instances of it live",
                       asset->live_instances);
  }
  impl_->assets.destroy(id);
  return {};
}

// What an instance has of its world.
static void join_world(const WorldState& state, Instance& instance) noexcept {
  instance.parameters.sleep_tolerance = state.def.sleep_tolerance;
  instance.parameters.most_m_s2 = state.def.teleport.acceleration * instance.asset->pack.character->height_m;
  instance.parameters.environment = &state.environment;
  world::notice_environment(instance);
}

// `made`: one for each of the asset's instances, in the slots' order.
static Status make_successors(const WorldState& state, const Asset& asset, Asset& by, AssetId by_id,
                              Instance* made) noexcept {
  for (uint32_t slot = 0; slot < state.instances.end(); ++slot) {
    const Instance* instance = state.instances.at(slot);
    if (!instance || instance->asset != &asset) continue;
    world::keep_hidden_ticks(state.rows[slot]);
    InstanceDef def = instance->def;
    def.asset = by_id;
    if (by.rod_network.record == nullptr && def.rod_start == RodWarmStart::kLearned)
      def.rod_start = RodWarmStart::kAsBaked;
    if (Status status = world::make_instance(by, def, made); !status.ok())
      return make_status(status.code, "replace_asset: %.200s", status.message);
    made->def.rod_start = instance->def.rod_start;
    world::go_on_as(*instance, *made);
    join_world(state, *made);
    ++made;
  }
  return {};
}

Status World::replace_asset(AssetId id, AssetId by_id) noexcept {
  const core::FloatingPointScope mode;
  Asset *asset = nullptr, *by = nullptr;
  if (Status status = find_asset(impl_, id, &asset); !status.ok()) return status;
  if (Status status = find_asset(impl_, by_id, &by); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  if (asset == by) return {};
  if (Status status = world::check_same_skeleton(*asset, *by); !status.ok()) return status;
  const std::unique_ptr<Instance[]> made(new (std::nothrow) Instance[asset->live_instances]);
  if (!made) return make_status(StatusCode::kOutOfCapacity, "replace_asset: no memory");
  if (Status status = make_successors(*impl_, *asset, *by, by_id, made.get()); !status.ok()) return status;
  Instance* next = made.get();
  for (uint32_t slot = 0; slot < impl_->instances.end(); ++slot) {
    Instance* instance = impl_->instances.at(slot);
    if (!instance || instance->asset != asset) continue;
    --asset->live_instances;
    asset->surface_instances -= instance->contacts.def.surface != nullptr;
    *instance = std::move(*next++);
    ++by->live_instances;
    by->surface_instances += instance->contacts.def.surface != nullptr;
    world::keep_row(*impl_, slot);
  }
  return {};
}

Status World::create_instance(const InstanceDef& def, InstanceId* out) noexcept {
  const core::FloatingPointScope mode;
  Asset* asset = nullptr;
  if (Status status = find_asset(impl_, def.asset, &asset); !status.ok()) return status;
  if (!out) return invalid("create_instance: out is a null pointer");
  if (busy(*impl_)) return refuse_busy();
  InstanceDef checked = def;
  if (Status status = world::check_root(def.root, &checked.root); !status.ok()) return status;
  checked.root = world::in_own_metres(checked.root, checked.root.scale);
  if (def.contacts.surface && def.contacts.surface == def.contacts.source)
    return invalid("create_instance: the surface is the source: rods would touch it twice");
  if (impl_->instances.count() == impl_->instances.capacity()) {
    return make_status(StatusCode::kOutOfCapacity, "create_instance: max_instances (%u) live",
                       impl_->instances.capacity());
  }
  Instance made;
  if (Status status = world::make_instance(*asset, checked, &made); !status.ok()) return status;
  join_world(*impl_, made);
  const bool has_surface = made.contacts.def.surface != nullptr;
  const InstanceId id = impl_->instances.create(std::move(made));
  if (is_null(id))
    return make_status(StatusCode::kOutOfCapacity, "create_instance: every slot's generations are used up");
  ++asset->live_instances;
  asset->surface_instances += has_surface;
  keep_row(*impl_, id);
  *out = id;
  return {};
}

Status World::destroy_instance(InstanceId id) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  --instance->asset->live_instances;
  instance->asset->surface_instances -= instance->contacts.def.surface != nullptr;
  impl_->instances.destroy(id);
  keep_row(*impl_, id);
  return {};
}

Status World::set_pose(InstanceId id, const Pose& pose) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  RootTransform root;
  if (Status status = world::check_pose(pose, instance->asset->pack.character->joint_count, &root);
      !status.ok()) {
    ++impl_->rejected_poses;
    return status;
  }
  RootTransform space;
  if (pose.space.id != 0) {
    RootTransform given = pose.space.root;
    given.scale = 1;  // not looked at
    if (Status status = world::check_root(given, &space); !status.ok()) {
      ++impl_->rejected_poses;
      return status;
    }
  }
  root = world::in_own_metres(root, root.scale);
  space = world::in_own_metres(space, root.scale);
  const bool rides_alike = pose.space.id == instance->state->motion.space_id &&
                           (pose.space.id == 0 || world::same_root(space, instance->state->motion.space));
  instance->state->poses.skips_pose = 0;
  impl_->rows[id.index1 - 1].skips_pose = false;
  const bool sleeps_on =
      instance->state->dormant && rides_alike && world::has_pose(*instance, pose.joints, root);
  std::copy(pose.joints.begin(), pose.joints.end(), instance->motion.next_joints);
  instance->state->motion.next_root = root;
  instance->state->poses.has_next = 1;
  instance->state->motion.next_space = space;
  instance->state->motion.next_space_id = pose.space.id;
  if (sleeps_on) return {};
  instance->state->teleports.told = pose.teleport;
  world::wake(*instance);
  world::bound_pose(*instance);
  world::keep_pose_row(*impl_, id.index1 - 1);
  return {};
}

Status World::skip_pose(InstanceId id) noexcept {
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  world::InstanceState& state = *instance->state;
  state.poses.skips_pose = !state.poses.has_next && !state.poses.at_start;
  impl_->rows[id.index1 - 1].skips_pose = state.poses.skips_pose != 0;
  return {};
}

namespace {

Status check_share(const char* what, float value, float most) noexcept {
  if (std::isnan(value)) return make_status(StatusCode::kNotFinite, "%s is NaN; it is unchanged", what);
  if (value >= 0 && value <= most) return {};
  return make_status(StatusCode::kInvalidArgument, "%s is %g, not in 0..%g; it is unchanged", what,
                     static_cast<double>(value), static_cast<double>(most));
}

}  // namespace

Status World::set_time_scale(InstanceId id, float scale) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  constexpr float kFastest = 4;
  if (Status status = check_share("set_time_scale: scale", scale, kFastest); !status.ok()) return status;
  instance->state->poses.time_scale = scale;
  keep_row(*impl_, id);
  return {};
}

Status World::set_felt_root_motion(InstanceId id, float share) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  if (Status status = check_share("set_felt_root_motion: share", share, 1); !status.ok()) return status;
  instance->state->motion.felt_root = share;
  return {};
}

namespace {

// Which of an instance's SetParameters: all's, a region's or a rod's.
enum class Whose { kAll, kRegion, kRod };
struct Owner {
  const char* function;
  Whose whose;
  uint32_t index = 0;
};

Status find_parameters(const Instance& instance, const Owner& owner, world::SetParameters** out) noexcept {
  if (owner.whose == Whose::kAll) {
    *out = &instance.state->parameters.all;
    return {};
  }
  const bool rod = owner.whose == Whose::kRod;
  const size_t count = rod ? instance.asset->pack.rods.size() : instance.asset->pack.regions.size();
  if (owner.index >= count)
    return make_status(StatusCode::kInvalidArgument, "%s: %s %u, the asset has %zu", owner.function,
                       rod ? "rod" : "region", owner.index, count);
  *out = &(rod ? instance.parameters.rod_tunings : instance.parameters.region_tunings)[owner.index].set;
  return {};
}

Status set_parameters_of(WorldState* state, InstanceId id, const Owner& owner,
                         const PartParameters& given) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  world::SetParameters* parameters = nullptr;
  if (Status status = find_state(state, id, &instance); !status.ok()) return status;
  if (busy(*state)) return refuse_busy();
  if (Status status = find_parameters(*instance, owner, &parameters); !status.ok()) return status;
  if (Status status = world::check_parameters(owner.function, given); !status.ok()) return status;
  *parameters = {given.intensity, given.stiffness, given.damping, given.displacement, given.enabled};
  if (world::notice_parameters(*instance)) world::publish(*instance);
  world::bound_pose(*instance);
  keep_row(*state, id);
  return {};
}

Status parameters_of(const WorldState* state, InstanceId id, const Owner& owner,
                     PartParameters* out) noexcept {
  Instance* instance = nullptr;
  world::SetParameters* set = nullptr;
  if (Status status = find_instance(state, id, &instance); !status.ok()) return status;
  if (!out) return make_status(StatusCode::kInvalidArgument, "%s: out is a null pointer", owner.function);
  if (Status status = find_parameters(*instance, owner, &set); !status.ok()) return status;
  *out = {set->intensity, set->stiffness, set->damping, set->displacement, set->enabled != 0};
  return {};
}

}  // namespace

Status World::set_parameters(InstanceId id, const PartParameters& of_all) noexcept {
  return set_parameters_of(impl_, id, {"set_parameters", Whose::kAll}, of_all);
}

Status World::set_region_parameters(InstanceId id, uint32_t region, const PartParameters& own) noexcept {
  return set_parameters_of(impl_, id, {"set_region_parameters", Whose::kRegion, region}, own);
}

Status World::set_rod_parameters(InstanceId id, uint32_t rod, const PartParameters& own) noexcept {
  return set_parameters_of(impl_, id, {"set_rod_parameters", Whose::kRod, rod}, own);
}

Status World::parameters(InstanceId id, PartParameters* out) const noexcept {
  return parameters_of(impl_, id, {"parameters", Whose::kAll}, out);
}

Status World::region_parameters(InstanceId id, uint32_t region, PartParameters* out) const noexcept {
  return parameters_of(impl_, id, {"region_parameters", Whose::kRegion, region}, out);
}

Status World::rod_parameters(InstanceId id, uint32_t rod, PartParameters* out) const noexcept {
  return parameters_of(impl_, id, {"rod_parameters", Whose::kRod, rod}, out);
}

Status World::set_environment(const Environment& environment) noexcept {
  const core::FloatingPointScope mode;
  if (!impl_) return null_world();
  if (busy(*impl_)) return refuse_busy();
  if (Status status = world::check_environment(environment); !status.ok()) return status;
  impl_->environment = environment;
  for (uint32_t slot = 0; slot < impl_->instances.end(); ++slot) {
    Instance* instance = impl_->instances.at(slot);
    if (!instance) continue;
    world::notice_environment(*instance);
    world::keep_pose_row(*impl_, slot);
  }
  return {};
}

Status World::environment(Environment* out) const noexcept {
  if (!impl_) return null_world();
  if (!out) return invalid("environment: out is a null pointer");
  *out = impl_->environment;
  return {};
}

Status World::set_added_environment(InstanceId id, const AddedEnvironment& added) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  if (Status status = world::check_added(added); !status.ok()) return status;
  instance->state->parameters.air.added = added;
  world::notice_environment(*instance);
  keep_row(*impl_, id);
  return {};
}

Status World::added_environment(InstanceId id, AddedEnvironment* out) const noexcept {
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (!out) return invalid("added_environment: out is a null pointer");
  *out = instance->state->parameters.air.added;
  return {};
}

Status World::set_importance(InstanceId id, float importance) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  instance->state->importance = frame::sane_importance(importance);
  keep_row(*impl_, id);
  return {};
}

Status World::set_views(std::span<const View> views) noexcept {
  const core::FloatingPointScope mode;
  if (!impl_) return null_world();
  if (busy(*impl_)) return refuse_busy();
  if (views.size() > kMostViews)
    return make_status(StatusCode::kInvalidArgument, "set_views: %zu views; give at most %u", views.size(),
                       kMostViews);
  frame::Sight sights[kMostViews];
  for (size_t v = 0; v < views.size(); ++v)
    if (Status status = frame::make_sight(views[v], &sights[v]); !status.ok()) return status;
  std::copy_n(sights, views.size(), impl_->views.sights);
  impl_->views.sight_count = static_cast<uint32_t>(views.size());
  return {};
}

Status World::set_hidden(InstanceId id, bool hidden) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  instance->state->hidden_by_caller = hidden;
  keep_row(*impl_, id);
  return {};
}

Status World::set_tier_limit(InstanceId id, Tier best) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  if (!world::may_limit(best))
    return make_status(
        StatusCode::kInvalidArgument,
        "set_tier_limit: best is %u, not kSkinning (0), kNetwork (2) or kModal (4); it is unchanged",
        static_cast<uint32_t>(best));
  world::limit_tier(*instance, best);
  keep_row(*impl_, id);
  return {};
}

Status World::reset(InstanceId id) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  world::forget_motion(*instance);
  world::publish(*instance);
  keep_row(*impl_, id);
  return {};
}

Status World::set_budget_us(float budget_us) noexcept {
  const core::FloatingPointScope mode;
  if (!impl_) return null_world();
  if (busy(*impl_)) return refuse_busy();
  if (!(budget_us >= 0)) return invalid("set_budget_us: the budget must be >= 0 or infinity");
  impl_->budget_us = budget_us;
  return {};
}

FrameReport World::step(float dt_s) noexcept {
  if (!impl_ || busy(*impl_)) return {};
  impl_->stepping = true;
  const FrameReport report = world::step(*impl_, dt_s);
  impl_->stepping = false;
  return report;
}

size_t World::state_bytes(InstanceId id) const noexcept {
  Instance* instance = nullptr;
  return find_instance(impl_, id, &instance).ok() ? world::snapshot_bytes(*instance) : 0;
}

Status World::save_state(InstanceId id, std::span<std::byte> out) const noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  return world::save(*instance, out);
}

Status World::restore_state(InstanceId id, std::span<const std::byte> bytes) noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_state(impl_, id, &instance); !status.ok()) return status;
  if (busy(*impl_)) return refuse_busy();
  if (Status status = world::restore(*instance, bytes); !status.ok()) return status;
  impl_->restored = true;
  world::notice_environment(*instance);
  keep_row(*impl_, id);
  return {};
}

}  // namespace sinew
