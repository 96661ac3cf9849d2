// world.hpp  The world: assets, instances, the step, what is read back.
//
//   sinew::World world;
//   sinew::Status status = sinew::World::create({}, &world);
//   sinew::AssetId asset;
//   status = world.load_asset_file("creature.sinew", &asset);
//   sinew::InstanceId creature;
//   status = world.create_instance({.asset = asset}, &creature);
//   for (;;) {
//     status = world.set_pose(creature, pose_from_the_engine);
//     sinew::FrameReport report = world.step(1.0f / 60);
//     status = world.read_positions(creature, {.out = vertices, .capacity = vertex_count});
//   }
//
// Thread rule: one thread at a time calls a world's functions, except where a function says otherwise. What
// step calls (hooks, contact and occlusion sources), on whatever thread, calls none of them: there, those
// that are not const are refused with kInvalidArgument, the assert hook hears of it, and a step inside the
// step does nothing. Nothing here throws or prints. step, set_pose, skip_pose, set_importance, set_views,
// set_hidden, set_tier_limit, set_time_scale, set_felt_root_motion, set_*parameters, set_*environment,
// set_budget_us, reset, sample_clip, read_*, bounds, debug_lines, report, history, take_events, save_state
// and restore_state never allocate or block; the others may allocate.
//
// Nothing here traps, and results do not depend on the calling thread's floating-point mode (rounding,
// denormals, trap masks): every function computes in its own and gives the thread's back whole. Callbacks
// that look something up inside a step (contacts, occlusion, clock, profiler) are called in the library's.
//
// Every function answers kInvalidArgument on a null world or for a null out, and kStaleId for an id that is
// null or whose object is gone (a programmer error: the assert hook hears of it). After a refusal nothing has
// changed.
#pragma once
#include "sinew/export.h"
#include "sinew/types.hpp"
#include "sinew/view.hpp"

namespace sinew {

class SINEW_API World {
 public:
  World() noexcept = default;  // null until create
  ~World();
  World(World&& other) noexcept;
  World& operator=(World&& other) noexcept;

  // Takes the tables' memory. A field outside its range: kInvalidArgument; no memory: kOutOfCapacity;
  // SINEW_ISA in the environment names an instruction set that is not there: kUnsupported. *out untouched.
  static Status create(const WorldDef& def, World* out) noexcept;

  // Checks the whole pack (O(bytes)), then uses it in place: bytes must outlive the asset and be 64-byte
  // aligned. Never reads outside bytes; refuses with a cause. Numbers that no character has, or that do not
  // go together: kCorrupt; a pack without a character, or with a network in the paper's wiring: kUnsupported;
  // max_assets loaded, or no memory: kOutOfCapacity; *out untouched on refusal.
  Status load_asset(std::span<const std::byte> bytes, AssetId* out) noexcept;
  // The same with the file memory-mapped for the asset's life; it must not be changed in place
  // meanwhile.
  Status load_asset_file(const char* path, AssetId* out) noexcept;
  // kInvalidArgument while instances of it live.
  Status unload_asset(AssetId asset) noexcept;
  // All instances of `asset` go on as instances of `by`, the same character baked anew: ids, poses, time and
  // what was set stay, what is shown goes on from where it is. Of parts with other names nothing is taken
  // over; a state that was saved before can no longer be restored. Other joints: kInvalidArgument; no memory:
  // kOutOfCapacity; then all is as it was. `asset` has no instances afterwards and may be unloaded.
  Status replace_asset(AssetId asset, AssetId by) noexcept;
  Status asset_info(AssetId asset, AssetInfo* out) const noexcept;
  Status asset_arrays(AssetId asset, AssetArrays* out) const noexcept;
  // Below, an index that is not there: kInvalidArgument, and *out is untouched.
  Status mesh_info(AssetId asset, uint32_t mesh, MeshInfo* out) const noexcept;
  Status primitive_info(AssetId asset, uint32_t primitive, PrimitiveInfo* out) const noexcept;
  Status joint_info(AssetId asset, uint32_t joint, JointInfo* out) const noexcept;
  Status region_info(AssetId asset, uint32_t region, RegionInfo* out) const noexcept;
  Status rod_info(AssetId asset, uint32_t rod, RodInfo* out) const noexcept;
  Status proxy_info(AssetId asset, uint32_t proxy, ProxyInfo* out) const noexcept;
  Status clip_info(AssetId asset, uint32_t clip, ClipInfo* out) const noexcept;
  // The joint's name in the file it was baked from, so that an engine can map its skeleton; lives as long as
  // the asset. Null for a stale id or joint >= joint_count.
  const char* joint_name(AssetId asset, uint32_t joint) const noexcept;
  // Names from the root down, "hips/spine/ear#2", no two alike unless names hold / or # themselves: the k-th
  // of several children of one parent with one name has #k, from the second on. Writes as much as fits,
  // zero-terminated, and returns the whole length, without the zero; 0 for a stale id or joint >=
  // joint_count. O(joints x depth).
  size_t joint_path(AssetId asset, uint32_t joint, std::span<char> out) const noexcept;
  // Whether a rod moves the joint, as its bone or as what hangs on one; what read_joint_matrices gives
  // differs from the pose for such joints alone. False for a stale id or joint >= joint_count.
  bool joint_is_on_rod(AssetId asset, uint32_t joint) const noexcept;
  // character-from-joint of the bind pose; out.size() must be joint_count, else kInvalidArgument and nothing
  // is written.
  Status bind_pose(AssetId asset, std::span<Matrix34> out) const noexcept;
  // character-from-joint of a clip's pose at a time, between its frames too; out as in bind_pose. A time that
  // is not finite: kNotFinite.
  Status sample_clip(AssetId asset, uint32_t clip, double time_s, ClipEnd end,
                     std::span<Matrix34> out) const noexcept;

  // One allocation for all of the instance's state, and with rods two or more, by their shapes. It starts at
  // rest in its bind pose; the first pose that is set counts as having been held for ever. max_instances
  // live, or no memory: kOutOfCapacity.
  Status create_instance(const InstanceDef& def, InstanceId* out) noexcept;
  Status destroy_instance(InstanceId instance) noexcept;

  // The pose at the end of the coming step; ticks between two poses see them interpolated. Joints are
  // copied. The last pose set before a step counts; without one the character stands still
  // (skip_pose: it goes on). Wrong count
  // or range: kInvalidArgument; NaN or infinity: kNotFinite; in both cases the last good pose stays and
  // the refusal is counted in the report.
  Status set_pose(InstanceId instance, const Pose& pose) noexcept;
  // Instead of set_pose, where animation runs at a lower rate than the frames: no pose is due in the coming
  // step. The step does nothing with the instance; what is read of it, root and joints too, stays as it was.
  // Its time goes to the step with the next pose, whose ticks follow the path between the two poses: flesh
  // moves as under a pose in each frame, and is shown as late as the poses are. That step has the ticks of
  // all the frames before it, so skip those of a crowd in turn; beyond WorldDef::max_ticks_per_step time is
  // dropped (8 ticks of 60 Hz: 0.13 s). Beside set_pose, before the first pose and while hidden it does
  // nothing. Part of the state that is saved. Fails for a stale id.
  Status skip_pose(InstanceId instance) noexcept;
  // Mended as in InstanceDef.
  Status set_importance(InstanceId instance, float importance) noexcept;
  // Where the world is seen from, at most kMostViews, until the next call. An instance that none shows is
  // hidden: it costs next to nothing and what is read of it stays as it was; coming back:
  // runtime/character/rest/hidden.hpp. Of the others the importance counts times the share of the view's
  // height that they take. No views, the default: all are seen, as large as any. A field outside its range:
  // kInvalidArgument or kNotFinite, the views stay.
  Status set_views(std::span<const View> views) noexcept;
  // The engine's own culling: hidden whatever the views show, until it says otherwise.
  Status set_hidden(InstanceId instance, bool hidden) noexcept;
  // The best it may get from the next tick on: kNetwork, the default, all; kModal no network; kSkinning
  // nothing is simulated, it fades to its pose as under a budget of 0. For quality settings, and to look at
  // one tier. What it may get it gets as any other; at its limit its report says TierReason::kBest. A change
  // wakes what is dormant. Others, kExtrapolate too: kInvalidArgument, it stays. Part of the state that is
  // saved; reset and replace_asset keep it.
  Status set_tier_limit(InstanceId instance, Tier best) noexcept;
  // From the next step on its time runs so many times as fast as the world's: 0 holds it, as a step of no
  // time does, 0.1 is slow motion. Poses are then those of its own time. 0..4, else kInvalidArgument, NaN:
  // kNotFinite; it stays. Part of the state that is saved.
  Status set_time_scale(InstanceId instance, float scale) noexcept;
  // Of what its root moves from the next step on it feels so much: 1, the default, all, 0 nothing (a
  // character whose clip moves it, under a root that an engine corrects). Contacts stay where the root is.
  // 0..1, else kInvalidArgument, NaN: kNotFinite; it stays. Part of the state that is saved.
  Status set_felt_root_motion(InstanceId instance, float share) noexcept;

  // How it swings, from the next tick on (parameters.hpp). Of a part its own numbers times the instance's,
  // held in the same ranges; it is on where both are. A number out of its range: kInvalidArgument, NaN:
  // kNotFinite, and so is a region or rod that there is not (kInvalidArgument); all stay as they were. Wakes
  // what is dormant. Part of the state that is saved; reset keeps it. Cost: while stiffness or damping of a
  // soft part glide, some 0.1 us a mode and tick.
  Status set_parameters(InstanceId instance, const PartParameters& of_all) noexcept;
  Status set_region_parameters(InstanceId instance, uint32_t region, const PartParameters& own) noexcept;
  Status set_rod_parameters(InstanceId instance, uint32_t rod, const PartParameters& own) noexcept;
  // As set last, whether it has come there or not; errors as above, *out untouched.
  Status parameters(InstanceId instance, PartParameters* out) const noexcept;
  Status region_parameters(InstanceId instance, uint32_t region, PartParameters* out) const noexcept;
  Status rod_parameters(InstanceId instance, uint32_t rod, PartParameters* out) const noexcept;
  // Gravity, acceleration and wind that all instances feel, from the next tick on; those made later begin in
  // it. Errors as above. In no snapshot: after a restore the instance glides from what it felt then to what
  // is set now. Cost: some tens of nanoseconds an instance.
  Status set_environment(const Environment& environment) noexcept;
  Status environment(Environment* out) const noexcept;
  // What this instance feels more than that; by default nothing. Part of the state that is saved.
  Status set_added_environment(InstanceId instance, const AddedEnvironment& added) noexcept;
  Status added_environment(InstanceId instance, AddedEnvironment* out) const noexcept;

  // Forgets motion: the tissue is at rest in the next pose that is set. What is read back has no displacement
  // from now on, as it has after a restore of what is saved now; its pose changes with the next step.
  Status reset(InstanceId instance) noexcept;

  // Microseconds a step may take (BudgetMode). Infinity, the default: the best tier for all; 0: skinning
  // for all; negative or NaN: kInvalidArgument. Reading back is not part of it.
  Status set_budget_us(float budget_us) noexcept;

  // Advances by dt_s >= 0 in fixed ticks of the assets' rate; the float nearest to 1/n s counts as
  // exactly that. NaN or negative counts as 0 (a pause: the pose moves, the tissue does not), more than
  // 1e6 s as 1e6 s. Never fails.
  FrameReport step(float dt_s) noexcept;

  // The reports of the last steps, newest first: as many as out and WorldDef::report_history hold and there
  // were. Returns how many; 0 for a null world. From any number of threads at a time, as read_positions.
  size_t history(std::span<FrameReport> out) const noexcept;

  // What happened since the last call, oldest first: as many as fit, which are then forgotten. Returns how
  // many. The same in every run; a restored state brings no events back.
  size_t take_events(std::span<Event> out) noexcept;
  // Since creation, for want of room (WorldDef::event_capacity).
  uint64_t events_lost() const noexcept;

  // Positions, at the time of the last step, of all of the asset's vertices. Cost O(vertices x
  // influences). A step that ends between ticks shows the state stepped on to its end. From any
  // number of threads at a time while no function that is not const runs.
  Status read_positions(InstanceId instance, const ReadDef& def) const noexcept;
  // Unit normals of the displaced surface: in the bind pose the file's own, else these
  // turned as the surface has turned there, so that hard edges stay hard and both sides of a sheet keep
  // theirs. out is written once and never read. Cost as read_positions and O(vertices + triangles). From
  // several threads at a time for different instances; for one instance, one thread at a time.
  Status read_normals(InstanceId instance, const ReadDef& def) const noexcept;
  // Positions, normals and tangents in one call, each in its own form, of all vertices or of those that
  // tissue can move: as read_positions and read_normals, whose thread rule it has. Cost: without normals and
  // tangents O(vertices written x influences), else as read_normals.
  Status read_surface(InstanceId instance, const SurfaceReadDef& def) const noexcept;
  // Points of the surface that is shown, as frames: the place, and x along the triangle's first edge, z along
  // its normal; of a triangle without area as rotated in the bind pose. For props, sockets and roots of hair.
  // A triangle that is not there, weights out of range, places.size() != out.size(): kInvalidArgument and
  // nothing is written. Some tenths of a microsecond each, whatever the asset's size. Threads as
  // read_positions.
  Status read_points(InstanceId instance, const PointsDef& def, std::span<const SurfacePlace> places,
                     std::span<Matrix34> out) const noexcept;
  // For culling, of the pose that was set last. Threads as read_positions.
  Status bounds(InstanceId instance, Bounds* out) const noexcept;
  // Lines that show what is simulated, in world axes from origin_m (finite). Writes as many as fit and
  // returns how many there are; 0 for a stale id. parts: of DebugParts. Threads as read_positions.
  size_t debug_lines(InstanceId instance, uint32_t parts, const double (&origin_m)[3],
                     std::span<DebugLine> out) const noexcept;
  // Character-from-joint of every joint at the time of the last step, for the engine's own skinning: the
  // pose's, but for bones that are rods and what hangs on them. The surface that read_positions gives is
  // skinned by these. out.size() must be joint_count, else kInvalidArgument and nothing is written. From any
  // number of threads at a time, as read_positions.
  Status read_joint_matrices(InstanceId instance, std::span<Matrix34> out) const noexcept;
  // From any number of threads at a time, as read_positions.
  Status report(InstanceId instance, InstanceReport* out) const noexcept;

  // Rollback. state_bytes is fixed for an instance's life, 0 for a stale id; a smaller span: save_state
  // refuses. Bytes of another asset, version, kind of ContactDef (a source or none, rods, own_body,
  // surface) or InstanceDef::rod_start, or changed ones: kCorrupt, the instance untouched. After a restore
  // the same poses, steps and tiers give the same bits; importance, waiting time and whose turn it is to be
  // looked at are part of the state.
  size_t state_bytes(InstanceId instance) const noexcept;
  Status save_state(InstanceId instance, std::span<std::byte> out) const noexcept;
  Status restore_state(InstanceId instance, std::span<const std::byte> bytes) noexcept;

 private:
  struct Impl;
  Impl* impl_ = nullptr;
};

}  // namespace sinew
