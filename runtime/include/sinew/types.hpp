// types.hpp  Plain definitions and results of the public API. SI units, right-handed, Y up (glTF 2.0).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "sinew/asset.hpp"
#include "sinew/event.hpp"
#include "sinew/id.hpp"
#include "sinew/matrix.hpp"
#include "sinew/parameters.hpp"
#include "sinew/read.hpp"
#include "sinew/status.hpp"

namespace sinew {

class ContactSource;    // contact_source.hpp
class OcclusionSource;  // view.hpp

// A double-precision place and a unit quaternion (x y z w), so that a character far from the origin loses
// nothing.
struct RootTransform {
  double position_m[3] = {0, 0, 0};       // within +-1e12
  float rotation_xyzw[4] = {0, 0, 0, 1};  // normalised on entry; zero length or NaN: refused
  // 1e-3..1e3, else refused: how many metres of the world one of the character's is. Flesh and rods move as
  // those of the character as it was baked do on a root whose travel is as much shorter, under the same
  // gravity; of a change of scale they feel nothing. What rods push against feels the mass and the speed of
  // the character as it was baked.
  double scale = 1;
};

// A space that a character rides on, by a number of the caller's choice. Between two poses that name the same
// one its motion is not felt. Who gets on, off or over feels its own way there, and nothing of the even speed
// that is then counted from something else.
struct RiddenSpace {
  uint32_t id = 0;          // 0: none
  RootTransform root = {};  // world from space; refused as a pose's root; its scale is not looked at
};

// One pose of one character. What set_pose refuses leaves the last good pose in place.
struct Pose {
  // Character-from-joint (before the inverse bind matrix), one for each of the asset's joints, in the asset's
  // order. Any affine matrix: scale, shear and mirroring are kept. Fewer or more, NaN or infinity, an entry
  // beyond +-1e6: refused. Flesh of joints that scale swings in the bind pose's metres as if they did not;
  // rods keep the length that was baked, and are shown as large as their joints.
  std::span<const Matrix34> joints = {};
  RootTransform root = {};  // world-from-character
  // What the character rides on (a lift, a vehicle); what it moves by is not felt.
  RiddenSpace space = {};
  // A cut: root and joints are taken to be elsewhere, not to have moved there (TeleportDef).
  bool teleport = false;
};

// Threads come from the caller. Contract: enqueue may run task(argument, index) for index 0..count-1 on any
// threads, in any order, each exactly once, and may return at once; finish returns when all of that call's
// indices have run. Both are called from the thread that calls step(), at most once a step. Low indices
// matter more. An index touches instances that no other does, and the results have the same bits for any
// number of threads and any order. Null enqueue: serial, on the stepping thread; enqueue without finish:
// World::create refuses.
struct TaskHook {
  using Task = void (*)(void* argument, uint32_t index);
  // Returns a ticket for finish.
  void* (*enqueue)(Task task, void* argument, uint32_t count, void* context) = nullptr;
  void (*finish)(void* ticket, void* context) = nullptr;
  void* context = nullptr;
};

// Monotonic nanoseconds; called on every thread that runs tasks. Null: the steady clock.
struct ClockHook {
  uint64_t (*now_ns)(void* context) = nullptr;
  void* context = nullptr;
};

// Called for programmer errors (a stale id, a second step inside a step), on the thread that made them; the
// call then answers with a Status as well, and nothing has changed. Null: abort in debug builds, ignore in
// release.
struct AssertHook {
  void (*fail)(const char* condition, const char* file, int line, void* context) = nullptr;
  void* context = nullptr;
};

enum class BudgetMode : uint32_t {
  // The budget is microseconds of the world's clock from the start of step(). Costs are corrected online. An
  // instance whose planned tier would not be done before the deadline gets the best cheaper one that would,
  // or is carried on as it was; it is counted as cut, and is the first to run in the next step, with the
  // ticks that it missed.
  kTime = 0,
  // The budget is baked microseconds: the same inputs give the same tiers and bits whatever the clock says.
  // Ticks that are made up for, two at most, and contacts, of whatever kind, are not counted.
  kWorkUnits = 1,
};

// Markers for a profiler (Tracy, Perfetto): begin and end in pairs, nested, on the thread that runs what they
// name; called from several threads at a time, inside a step, so they neither block nor call the world. name
// lives as long as the program: "schedule", "instance", "drive", "tissue", "rods", "publish", "idle",
// "report". instance: its slot (InstanceId::index1 less one), kNoInstance where it is of none. Both null:
// none; one alone: World::create refuses.
inline constexpr uint32_t kNoInstance = 0xffffffffu;
struct ProfilerHook {
  void (*begin)(const char* name, uint32_t instance, void* context) = nullptr;
  void (*end)(const char* name, uint32_t instance, void* context) = nullptr;
  void* context = nullptr;
};

// What a step takes for a teleport and not for a motion: the root, or a joint beside it (in the character's
// space), ends further than this from where its motion of the last step would have brought it, or
// Pose::teleport says so. What hangs on it is carried: soft parts and rods keep their shape and what they
// swing with, and feel nothing of it, nor of a step after it that goes on at quite another speed.
// In frames longer than 1/60 s as much is allowed for each 1/60 s of them; in a step of no time nothing is,
// whatever stands here. A velocity of the root that begins at once and lasts is taken to have been there
// after one step; a joint's is a teleport as long as it lasts. InstanceReport::teleports counts them.
struct TeleportDef {
  float distance = 0.15f;  // > 0, of the character's height in its bind pose; infinity: never
  float angle_rad = 0.5f;  // > 0; infinity: never
  float scale = 1.25f;     // > 1, by so much a joint grows or shrinks; infinity: never
  // > 0, heights/s^2, infinity: none. What is felt of the root's and the nodes' acceleration in motions that
  // are no teleports: as it is up to half of this, from there approaching it smoothly.
  float acceleration = 150;
};

// A field outside its range: World::create refuses.
struct WorldDef {
  uint32_t max_assets = 16;     // 1..65535; one more load is refused with kOutOfCapacity
  uint32_t max_instances = 64;  // 1..100000; one more create is refused with kOutOfCapacity
  // 1..64; a longer frame drops the excess at its start and reports it. Of a tick rate of 60 Hz 8 are 0.13 s.
  uint32_t max_ticks_per_step = 8;
  TeleportDef teleport = {};
  // 0..1, a share of a soft part's radius. A part that neither moves nor feels anything new by more than that
  // for half a swing falls asleep: it keeps its shape at next to no cost until it feels more
  // (runtime/character/rest/sleep.hpp). 0: never.
  float sleep_tolerance = 2e-5f;
  uint32_t report_history = 120;  // 0..65535 FrameReports kept for World::history
  uint32_t event_capacity = 256;  // 0..65535 events kept for World::take_events; of more the oldest are lost
  BudgetMode budget_mode = BudgetMode::kTime;
  // Asked whether something hides what views show (World::set_views); null: nothing does. Outlives the world.
  OcclusionSource* occlusion = nullptr;
  uint32_t sight_rays_per_step = 64;  // so many questions a step, and what one instance takes in all views,
                                      // eight for an instance and view; < 8: none
  TaskHook tasks = {};
  ClockHook clock = {};
  AssertHook assert_hook = {};
  ProfilerHook profiler = {};
};

// What an instance touches. It is asked tick by tick, where the instance is simulated; the source
// outlives the instance. Instances are stepped on the world's threads, so find may come from several at a
// time.
struct ContactDef {
  ContactSource* source = nullptr;  // null: nothing is asked
  uint32_t owner = 0;               // ContactProbe::owner of all its probes
  bool tissue = true, rods = true;  // what of the instance touches the source
  // Its rods, and those of its soft parts whose recipe says "touches_body", touch the capsules about its own
  // bones that were baked, too, with a source or without. Costs a sweep of each segment a tick, some compares
  // of each such soft part, and what contacts cost.
  bool own_body = false;
  // The character's own skin and others', at full resolution: sinew::SurfaceContacts. Its rods alone ask it,
  // whatever `rods` says, and only on tiers that afford it: modal and network on the finest control graph.
  // On all others the capsules of own_body stand in its place, without own_body nothing does; others' bodies
  // are then touched where the source has them. Nothing is pushed in it. What rods are found inside of, of
  // whatever kind, lets them out by 2 % of the height a second. Null: rods touch the capsules on every tier;
  // the same as source: refused; without rods: not asked. Outlives the instance, as the source does.
  ContactSource* surface = nullptr;
};

// What the iteration of a rod's tick starts from. Where it ends is the same within the solver's tolerance
// (0.01 rad a segment); how many iterations that takes, and what they cost, is not.
enum class RodWarmStart : uint32_t {
  kAsBaked = 0,    // as the recipe says of each rod ("start"); of most: continued
  kContinued = 1,  // the last ticks' forces, continued
  kLearned = 2,    // the same, corrected by a COPINGNet (Shao et al. 2021) in the pack
};

struct InstanceDef {
  AssetId asset = {};  // null or stale: refused
  // >= 0, relative weight for the scheduler: of a visible millimetre of error. 0: gets what the others leave;
  // NaN or negative counts as 0. The rule, and how long an instance with importance above 0 may go
  // unsimulated at most: runtime/schedule/scheduler.hpp.
  float importance = 1;
  RootTransform root = {};  // where it enters, in its bind pose, at rest; refused as in a pose
  ContactDef contacts = {};
  // Of all its rods. kLearned of an asset without a network for rods (AssetInfo::rod_network): refused. What
  // it takes more than as baked, of memory and time, is not in instance_bytes nor in the tiers' baked costs.
  RodWarmStart rod_start = RodWarmStart::kAsBaked;
  // 1..1000, else refused: iterations of a tick at most, of each rod. Rods that stop earlier are exact to
  // 0.01 rad; with few, joints give and swings are damped, at a time that is known.
  uint32_t max_rod_iterations = 12;
  bool report_rod_residual = false;  // fills InstanceReport::rod_residual, for a fifth of an iteration's time
};

// What an instance got in a frame. In rising quality: skinning, extrapolate, modal, network; the last two are
// simulated. Values are baked into packs: never renumbered, and 3 is not used again.
enum class Tier : uint32_t {
  kSkinning = 0,     // displacement is zero, or fading to it (12 to 28 ticks, 0.2 to 0.47 s at 60 Hz)
  kExtrapolate = 1,  // the last displacement swings on, damped (4 ticks), then fades
  kNetwork = 2,      // the modal base, corrected by the asset's network
  kModal = 4,        // the modes of each soft part, from its flesh: no training
};
inline constexpr uint32_t kTierCount = 5;  // of values, with the one that is not used

// Why an instance got what it got.
enum class TierReason : uint32_t {
  kBest = 0,     // there is nothing better, or it may have nothing better (World::set_tier_limit)
  kBudget = 1,   // more is not affordable, or better spent on others
  kHeld = 2,     // as kBudget, and what it has is held for a while
  kTurn = 3,     // as kBudget; simulated because it had waited too long
  kWaiting = 4,  // not simulated for longer than the scheduler wants; its turn comes
  kCut = 5,      // was to get more, but the deadline came too near
  kHidden = 6,   // nobody sees it: World::set_views, set_hidden
  kGuard = 7,    // a guard fired: on its modal base, or fading to skinning, for now
  kStill = 8,    // simulated, and all of its soft parts are asleep
};
inline constexpr uint32_t kTierReasonCount = 9;

struct InstanceReport {
  InstanceId instance = {};
  Tier tier = Tier::kSkinning;
  TierReason why = TierReason::kBudget;
  float error = 1;                   // estimated of this tier, a share of skinning's; 1 where not simulated
  uint32_t graph_level = 0;          // of control graphs, 0 the finest: AssetInfo::graph_levels
  float blend = 0;                   // 0..1, weight of the simulated displacement in what is read back
  uint32_t ticks_since_network = 0;  // 0: its last tick was the network's; counts on where the asset has none
  // Counters since creation.
  uint32_t input_clamps = 0;         // network inputs outside the baked envelope
  uint32_t displacement_clamps = 0;  // regions and ticks that would have swung beyond the baked limit
  // The network's state was given up: NaN or infinity in it. The modal base takes over for 60 ticks, then the
  // network starts anew.
  uint32_t fallbacks = 0;
  // All state was given up, faded to skinning and restarted: NaN or infinity in the modal base.
  uint32_t restarts = 0;
  uint32_t regions_asleep = 0;    // soft parts at rest, left out until they feel more
  uint32_t regions_left_out = 0;  // soft parts that its control graph does not have: they are skinned
  // Since creation, TeleportDef: steps in which the root teleported; soft parts and rods, a step each, whose
  // joints did.
  uint32_t teleports = 0, part_teleports = 0;
  // Since creation: rods that had to be put together or put back where they are held.
  uint32_t rod_recoveries = 0;
  uint32_t rods_asleep = 0;  // rods at rest, not stepped until they are held or shaped otherwise: all or none
  uint32_t rod_iterations = 0;  // of the last tick: of all rods' solvers together; 0: asleep or not simulated
  // Of the last tick, of the rod that has most: what the tick's equations miss by, in mean segments' lengths,
  // radians, and shares of the rod's largest force, contacts counted in; infinite where one had to be put
  // back. 0 without InstanceDef::report_rod_residual.
  float rod_residual = 0;
  // Of the last tick, where the instance has a contact source or own_body. A vertex counts once for each
  // thing it touches. The volume is at most what contacts took from the soft parts: of vertices that touched
  // something, area times way.
  uint32_t rod_contacts = 0;        // near enough to be looked at
  bool rods_touch_surface = false;  // ContactDef::surface; false: what stands in its place
  uint32_t vertices_touched = 0, contacts_refused = 0, contacts_dropped = 0;
  float contact_volume_m3 = 0;
  // What soft parts are left inside: no contact shows one further out than its displacement limit, nor a
  // vertex further than half of the bind pose's largest extent.
  float deepest_penetration_m = 0;
  float cost_us =
      0;  // what this instance took in the last step, on its thread; 0: next to nothing, not measured
  float planned_us = 0;  // what it was expected to take; kWorkUnits: of the baked costs
  bool hidden = false;   // nobody saw it in the last step: nothing was done for it
  bool dormant = false;  // asleep under an unchanged pose: from the next step on nothing is done for it
};

// Filled by step(). All times in microseconds of the world's clock.
struct FrameReport {
  uint64_t frame = 0;   // steps before this one
  uint32_t ticks = 0;   // fixed ticks simulated; the most of any instance
  float dropped_s = 0;  // time beyond max_ticks_per_step, not simulated; the most of any instance
  float budget_us = 0;  // as set; infinity: no limit
  float total_us = 0;   // the whole step
  // Stages: choosing tiers; poses, node frames and drive; modes, network and guards; bones that are
  // rods; displacement brought to the end of the step (of rods too) and to the surface. The last four are
  // summed over the instances: on several threads they may exceed total_us.
  float schedule_us = 0, drive_us = 0, tissue_us = 0, rods_us = 0, publish_us = 0;
  // Each instance once; one whose extrapolation has faded away counts as skinned.
  uint32_t instances_network = 0, instances_modal = 0, instances_extrapolated = 0, instances_skinned = 0;
  uint32_t instances_hidden = 0;  // nobody sees them; in none of the counts above
  uint32_t instances_dormant =
      0;                       // asleep under an unchanged pose and not stepped; in the counts of their tiers
  uint32_t instances_cut = 0;  // got a cheaper tier than planned, or are shown as they were, for the deadline
  uint32_t restarts = 0, fallbacks = 0;  // instances in this frame
  uint32_t regions_asleep = 0;           // soft parts at rest, of all instances
  uint32_t rejected_poses = 0;           // set_pose calls refused since the last step
  float unspent_us = 0;  // of the budget while a budget kept an instance below its best; else 0
  // Mean over the instances that are seen of their tiers' errors, a share of skinning's; 1: all are skinned,
  // or none is seen. As baked; where nothing was measured, usual ones (runtime/schedule/front.hpp).
  float expected_error = 1;
  bool over_budget = false;  // kTime: total_us > budget_us; kWorkUnits: the baked cost of what ran is
};

}  // namespace sinew
