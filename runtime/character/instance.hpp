// instance.hpp  One character in the world: its state, which can be saved as bytes, and its scratch.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "character/asset/asset.hpp"
#include "character/contacts/scaled_source.hpp"
#include "character/motion/pose.hpp"
#include "character/parameters/tuning_state.hpp"
#include "character/rods/rod_source.hpp"
#include "core/aligned_block.hpp"
#include "rods/contacts/collider.hpp"
#include "rods/rod_batch.hpp"
#include "schedule/tick_clock.hpp"
#include "schedule/visibility/sight.hpp"
#include "sinew/contact_source.hpp"
#include "sinew/types.hpp"
#include "tissue/frames/fraction_step.hpp"
#include "tissue/frames/node_pose.hpp"

namespace sinew::world {

// In ticks of the asset's rate; at 60 Hz 0.07 s, 0.2 s and 0.33 s.
inline constexpr uint32_t kCarryTicks = 4;  // swings on before the fade begins: by then it is more than half
                                            // as far off as skinning, and soon as far
inline constexpr uint32_t kFadeTicks = 12;  // from there to skinning, at least
inline constexpr uint32_t kLongestFadeTicks = 28;  // of what would else be seen to go
inline constexpr uint32_t kBlendInTicks = 20;  // from that to simulation, when it comes back: by then most
                                               // of the swing of starting from the wrong place has died down
inline constexpr uint32_t kLongestBlendTicks =
    60;  // where that would move something far (character/transition/blend_pace.hpp)
// A network that missed at most so many ticks keeps its memory when it comes back; after more, its velocities
// are of another phase of the wobble and it starts anew from where it is.
inline constexpr uint32_t kRememberedTicks = 2;
// Over so many ticks the corrections of one without a memory rise to the whole.
inline constexpr uint16_t kNetworkBeginTicks = 8;
// What was left alone for no longer makes up for it when it comes back (character/transition/catch_up.hpp).
inline constexpr uint32_t kCaughtUpTicks = 2;
// Share of its velocity that a tail keeps each tick: nothing flings, it stands still soon, and then costs
// nothing to publish.
inline constexpr float kCarryDamping = 0.6f;
// In one question; as many hits of a contact source as of the own body.
inline constexpr uint32_t kProbesAtOnce = 128, kHitsAtOnce = 2 * kProbesAtOnce;
inline constexpr uint32_t kFallbackTicks = 60;  // on the modal base, after a network's state was given up

// The part of the state that is not an array. Plain bytes: saved and restored as they are.
struct InstanceState {
  // What a plan does to those that it passes over comes first: kPlannedStateBytes of it.
  double remainder_s = 0;  // schedule/tick_clock.hpp
  float importance = 1;
  float excitation = 1;                             // character/motion/excitation.hpp
  float waited_s = 0, held_s = 0, turn_left_s = 0;  // schedule/scheduler.hpp
  Tier tier = Tier::kSkinning;                      // in the last step
  uint32_t level = 0;                         // of control graphs (character/transition/change_level.hpp)
  uint32_t restarting = 0;                    // fading out after a guard: not simulated until faded
  uint32_t fallback_ticks = 0;                // left until the network may be tried again
  uint32_t dormant = 0;                       // character/rest/dormant.hpp
  uint32_t hidden = 0, hidden_by_caller = 0;  // character/rest/hidden.hpp
  uint32_t blind_looks = 0;                   // in a row (world/step/look.hpp)
  float blend_ticks = 0;  // of the way since simulation came back, at most kBlendInTicks; one a tick or less

  RootTransform root, next_root;    // at the end of the last step; of the pose set since
  RootTransform space, next_space;  // likewise, of Pose::space; character/motion/root_motion.hpp
  double dt_older_s = 0;            // of the step before the last
  double dt_before_s = 0;           // of the last step; 0: none, or none to compare with
  double velocity_m_s[3] = {};      // of the root over the last step, world
  double angular_velocity[3] = {};  // rad/s, character axes
  double velocity_before_m_s[3] = {}, angular_velocity_before[3] = {};  // likewise, of the step before that
  double ride_velocity_m_s[3] = {};                                     // of what it rides on, where it is
  // character/motion/teleport.hpp: of the step that teleported last.
  double teleport_velocity_m_s[3] = {}, teleport_spin[3] = {};
  double tick_root_m[3][3] = {};  // of the last three ticks, newest first
  float render_fraction = 0;      // remainder in ticks: how far beyond the last tick is shown
  uint32_t has_next = 0;          // set_pose since the last step
  uint32_t at_start = 1;          // no pose yet: the first one is taken as having been held for ever
  uint32_t motion_stale = 1;      // ticks were not followed: the motion history is rebuilt before use
  uint32_t forgotten = 1;         // the network's state is no memory of this motion: a start, a guard
  uint32_t tail_ticks = kCarryTicks + kFadeTicks;  // since the tail began
  uint16_t fade_ticks = kFadeTicks;                // of the tail
  uint16_t network_begins = 0;  // ticks left in which a network without a memory corrects by less
  uint32_t rest_ticks = 0;      // left in which what comes back begins at rest
  uint32_t ticks_since_network = 0;
  uint32_t input_clamps = 0, displacement_clamps = 0, fallbacks = 0, restarts = 0;
  uint32_t untouched = 1;  // no tick since the first pose: displacement is exactly zero
  uint32_t rod_recoveries = 0;
  double rod_anchor_m[3] = {};   // of the world, where rods' places count from: near, so that they stay exact
  uint32_t rod_quiet_ticks = 0;  // character/rest/rod_sleep.hpp
  uint16_t teleported = 0;       // the root, in the last step
  uint16_t teleport_told = 0;    // Pose::teleport, of the pose set since
  uint32_t hidden_ticks = 0;     // character/rest/hidden.hpp
  uint32_t from_shown = 0;       // simulation came back from what was shown, and not from rest
  Tier tier_limit : 16 = Tier::kNetwork;  // character/tier_limit.hpp
  Tier left_tier : 16 =
      Tier::kSkinning;  // character/transition/catch_up.hpp: what it had before it was left alone
  uint16_t missed_ticks = 0, tail_rides = 0;  // likewise: since then; the tail counts from what is simulated
  uint32_t first_joints = 0;                  // which of pose_joints is the oldest pose
  uint32_t looked = 0;                        // world/step/look.hpp: the number of the last look at it
  uint32_t still_ticks = 0;                   // character/rest/dormant.hpp
  uint32_t seam_ticks = kBlendInTicks;        // since the level changed, at most kBlendInTicks
  uint32_t space_id = 0, next_space_id = 0;
  uint32_t space_changed = 0, carried_capsules = 0;  // in the last step; character/motion/teleport.hpp
  float time_scale = 1, felt_root = 1;               // World::set_time_scale, set_felt_root_motion
  uint32_t root_teleports = 0, part_teleports = 0;   // since creation
  uint16_t is_off = 0;                               // character/output/between_ticks.hpp
  uint16_t skips_pose = 0;       // none is due in the coming step (world/step/skip_pose.hpp)
  float blend_pace = 1;          // of the last tick: what blend_ticks rose by
  double without_pose_s = 0;     // of its own time, since the last one was due
  AirState air;                  // character/parameters/air.hpp
  SetParameters all_parameters;  // World::set_parameters
  uint16_t tuned = 0,
           tuning_moves = 0;  // character/parameters/tuning.hpp: of what; something glides or blows
};
inline constexpr size_t kPlannedStateBytes = offsetof(InstanceState, root);
static_assert(kPlannedStateBytes == 64);  // a cache line

// What the last step measured; not state.
struct InstanceTimes {
  uint64_t drive_ns = 0, tissue_ns = 0, rods_ns = 0, publish_ns = 0, total_ns = 0;
};

// What the last tick tells of rods and of what was touched; not state.
struct TickTold {
  uint32_t rod_iterations = 0;  // of all solvers
  float rod_residual = 0;       // of the rod that has most
  uint32_t rod_contacts = 0;
  uint32_t vertices = 0;  // touched, or pushed out
  uint32_t refused = 0;   // the source's answers that were none
  uint32_t dropped = 0;   // contacts there was no room for
  float volume_m3 = 0;    // that contacts took from the soft parts
  float deepest_m = 0;    // that a vertex is left inside
  uint32_t touches = 0;   // in Instance::touches
};

// One vertex against one half-space in a tick.
struct Touch {
  uint32_t region, node, vertex;  // of the character; in its surface's patches
  float normal[3] = {};           // world, out of what is touched
  float gap_m = 0;                // where nothing presses
  float place_m[3] = {};          // is there, from the tick's root
  float start_m[3] = {};          // where it was shown a tick ago, from that tick's root
};

// What a step does with an instance: taken over from the plan's answer as its task begins, and of those that
// are passed over set by the plan.
struct InstancePlan {
  frame::TickPlan ticks;
  double dt_s = 0;  // of its own time (World::set_time_scale)
  Tier tier = Tier::kSkinning;
  uint32_t level = 0;  // of control graphs
  float cost_us = 0;   // expected
  float behind_us =
      0;  // that those which run later are expected to take; idle ones as one step in twenty does
  TierReason why = TierReason::kBudget;
};

// Instance::regained: not simulated since.
inline constexpr uint32_t kRegained = 1, kRegainedNow = 2;

// What a tick of emulated patches is told and says, [nodes][3] in metres from the root's last tick
// (character/tissue/emulate.hpp); none without such regions.
struct EmulatorScratch {
  float *u_now = nullptr, *u_before = nullptr, *u_next = nullptr;
  float *x_now = nullptr, *x_before = nullptr, *x_next = nullptr;
  tissue::PatchView* views = nullptr;  // [nodes]
  float* l = nullptr;                  // as the network has it, along nodes' frames
  float* step = nullptr;               // of its kernels
};

struct TunedRegion;  // character/parameters/tuning.hpp

// Arrays are [nodes][3] in metres along each node's frame (tissue/frames/node_bend.hpp) unless said
// otherwise; l, theta and q as in tissue/modes/modal_base.hpp. u is what may be shown of l, within the
// region's limit (tissue/modes/guard.hpp). "Shown" is what is published, along the axes of the flesh, as is
// the tail: poses need not be followed to carry them on. shown = b u + (1 - b) tail, b rising smoothly from 0
// to 1 in kBlendInTicks or more (character/transition/blend_pace.hpp). The tail is the displacement shown
// when simulation was last left, carried on with damped velocity and then faded to zero; or, where it rides,
// what that was off, and shown = u + (1 - b) tail, b rising more gently.
struct Instance {
  // What a plan does to those that it passes over, and what a report asks, comes first: kPlannedBytes of it.
  InstanceState* state = nullptr;
  Asset* asset = nullptr;
  frame::Ball bound;       // character/motion/pose_bound.hpp
  float cost_factor = 1;   // what its ticks take as a multiple of its asset's, smoothed; not state
  bool came_back = false;  // in this step
  bool cut = false, restarted = false, fell_back = false;  // in the last step
  bool held = false;       // in the last step: shown as it was, for the deadline
  bool displaced = false;  // published displacement is not zero everywhere
  bool passed = false;     // in the last step: not stepped, dormant or waiting for a pose
  InstancePlan plan;

  bool entered = false;        // in the last step: simulation began anew, which costs more than to go on
  uint8_t events = 0;          // in the last step, a bit for each EventKind (character/output/events.hpp)
  uint8_t made_up = 0;         // in the last step: missed ticks that were simulated after all
  bool parts_ready = false;    // in this step: the parts are filled in
  bool changed_level = false;  // in the last step
  bool refined = false;        // to a finer one
  InstanceTimes times;
  core::AlignedBlock memory;
  uint64_t between_ns = 0;  // of times.publish_ns: a provisional step (character/output/between_ticks.hpp)
  AssetId asset_id;
  InstanceDef def;  // what it was made by, as the caller gave it; not of what set_* has changed since
  const GraphLevel* level = nullptr;  // of the asset: state->level
  bool level_raised = false;          // in this step: its nodes' past poses are not known
  bool rods_anew = false;     // in this tick: rods are taken to where they are shown before they go on
  bool rods_shown = false;    // published joints are not the pose's
  float most_m_s2 = 0;        // TeleportDef::acceleration, in metres; as by default until set
  float sleep_tolerance = 0;  // WorldDef::sleep_tolerance, likewise
  const Environment* environment = nullptr;  // the world's; null: as by default
  // own_body and surface: only where there is something to touch. Without a source and soft parts that touch
  // the body, the arrays of contacts have no memory.
  ContactDef contacts;
  RodWarmStart rod_start = RodWarmStart::kAsBaked;
  std::unique_ptr<rods::RodBatch[]> rod_batches;       // their state is saved beside the run of bytes below
  std::unique_ptr<rods::RodCollider[]> rod_colliders;  // [batches], theirs too; null: rods touch nothing
  std::unique_ptr<ScaledSource> scaled[2];             // contacts.source and surface; null: there is none
  std::unique_ptr<RodSource> rod_source;               // what they ask; null: contacts.source at most

  // State: one run of bytes from `state` on.
  Matrix34* pose_joints[4] = {};  // [joints], in turn:
  Matrix34 *joints_older = nullptr, *joints_before = nullptr, *joints = nullptr,
           *next_joints = nullptr;  // point there
  tissue::NodePose* poses[3] = {};  // [nodes] of the last three ticks, newest first
  float* network_state = nullptr;
  float *u[2] = {}, *l[2] = {}, *theta = nullptr;  // newest first
  float *q[2] = {}, *r[2] = {};                    // q: [modes of all regions]
  // [modes]: by how much a network's corrections have moved q since it began, as modes go on with them.
  float* corrected[2] = {};
  float* swing = nullptr;                           // [regions]: tissue/modes/correction_budget.hpp
  tissue::TickForce tick_force{};                   // of the last tick
  float *tail = nullptr, *tail_velocity = nullptr;  // velocity a tick
  float* shown[2] = {};                             // newest first
  float* felt_asleep = nullptr;     // m/s^2, when the region's quiet began (character/rest/sleep.hpp)
  uint32_t* quiet_ticks = nullptr;  // [regions]
  uint32_t* regained =
      nullptr;  // [regions]: a change of level had it again, and it is blended in; kRegainedNow
  // character/motion/teleport.hpp: of joints, what teleported in the last step; what is carried over in the
  // next tick.
  uint32_t *joint_teleports = nullptr, *carried_regions = nullptr, *carried_rods = nullptr;
  // Of rods, [slots][4]: how a segment is turned against its rest, x y z w along its own axes; as u, shown
  // and tail are for tissue.
  float *rod_turn = nullptr, *rod_shown[2] = {}, *rod_tail = nullptr;
  float* rod_tail_velocity = nullptr;                        // [slots][3]: rotation vector a tick
  double *rod_asleep = nullptr, *rod_hold_asleep = nullptr;  // rest and hold when their quiet began
  // Of the last two ticks, newest first: [slots][4] segments' orientations in the world at rest, and where
  // rods are held, [rods][3] then [held ends][3], from rod_anchor_m.
  double *rod_rest[2] = {}, *rod_hold[2] = {};
  double* proxy_ends[2] = {};  // likewise, [proxies][2][3]; null: it does not touch its body
  // Of soft parts that may touch something, else null: how vertices are pushed, laid out and along axes as
  // `carried`, and whether any of a region's is.
  float* pushes = nullptr;
  uint32_t* pushed = nullptr;  // [regions]
  float* seam = nullptr;       // laid out as `carried`: what a change of level left, null: one level
  // Of the last two ticks, newest first, where something may be touched: [joints][12], and the root's turn.
  float *tick_skin[2] = {}, *tick_turn[2] = {};
  PartTuning *region_tunings = nullptr,
             *rod_tunings = nullptr;  // [regions], [rods]: character/parameters/tuning.hpp
  size_t state_bytes = 0;

  // What follows from these, of the level that it has; looked at where InstanceState::tuned has kTunedParts.
  pack::ModeRecord* tuned_modes = nullptr;      // [modes]
  tissue::SwingSlopes* tuned_slopes = nullptr;  // as GraphLevel::swing_slopes
  TunedRegion* tuned_regions = nullptr;         // [regions]

  // Scratch of a step.
  JointParts *parts_older = nullptr, *parts_before = nullptr, *parts = nullptr,
             *next_parts = nullptr;  // [joints]
  RootStep root_step{}, root_step_before{};
  Matrix34* tick_joints = nullptr;        // [joints]
  tissue::NodePose* poses_now = nullptr;  // [nodes] at the end of the step
  float* shown_between = nullptr;         // character/output/between_ticks.hpp
  float* drive = nullptr;                 // [nodes][kNodeDriveWidth]
  bool scaled_nodes = false;              // in this tick: node_size is not 1 everywhere
  EmulatorScratch emulator;
  float *joint_size = nullptr, *node_size = nullptr;  // [joints], [nodes]
  float *felt = nullptr, *l_hat = nullptr, *r_hat = nullptr, *q_hat = nullptr, *carry = nullptr;
  float *inputs = nullptr, *network_scratch = nullptr;
  float* trust = nullptr;            // [regions]: tissue::trust_in of this tick
  float* region[2] = {};             // [widest_region]: one region's x y z and modes
  tissue::NodeRun* awake = nullptr;  // [regions]
  float* level_scratch = nullptr;    // character/transition/change_level.cpp; null: one level

  ContactProbe* probes = nullptr;  // [kProbesAtOnce]
  ContactHit* hits = nullptr;      // [kHitsAtOnce], and as many of the own body where it is touched
  Touch* touches = nullptr;        // [2 carried vertices]
  uint32_t touch_count = 0;
  float* flesh = nullptr;             // [nodes][3]: displacement along the axes of the flesh
  float touched_moves_m = 0;          // in the tick, at most
  uint32_t* deepest = nullptr;        // [nodes]: of touches
  uint8_t* touched = nullptr;         // [carried vertices]
  uint8_t* carries_pushes = nullptr;  // [regions]: `carried` has pushes in it
  TickTold told;
  // proxy_ends a tick ago, whoever sleeps; null: soft parts do not touch them.
  double* proxy_before = nullptr;

  double *rod_rest_now = nullptr,
         *rod_hold_now = nullptr;  // as rod_rest and rod_hold, at the end of the step
  float *rod_orientations = nullptr,
        *rods_between = nullptr;  // [slots][4], there: in the world, and as shown
  float* rod_velocity = nullptr;  // [slots][6], of rods that are carried: beside the pose's, along own axes
  double* rod_end[2] = {};        // [slots][3] where segments end, as they are taken along

  // Published by a step, read by read_*.
  float* skin = nullptr;      // [joints][12], where they are too many for a reader's stack; scratch of a tick
  float carried_share = 1;    // of `carried`, in what is read: a tail that fades is not carried anew
  float* delta = nullptr;     // [nodes][3], bind-pose axes
  bool carries_seam = false;  // `carried` has some of the seam in it
  uint32_t carried_level = 0;  // by whose weights it was carried
  float* carried = nullptr;    // of delta: a region after the other [3][padded_vertices], bind-pose axes
  float* surface = nullptr;    // [vertices][3], scratch of read_normals
  float* areas = nullptr;      // the same
  const float* rods_published = nullptr;  // rod_shown[0] or rods_between
  Matrix34* rod_motion = nullptr;         // [slots]: how rods move the pose's bones, in the character's space
  Matrix34* rod_joints = nullptr;         // [joints], where there are rods: the pose's, moved by them
};

inline constexpr size_t kPlannedBytes = offsetof(Instance, memory);
static_assert(kPlannedBytes <= 176);  // three cache lines with what the table of instances has before it

inline TierCosts& costs_of(const Instance& instance) noexcept {
  return instance.contacts.surface ? instance.asset->surface_costs : instance.asset->costs;
}

// Points joints_before, joints and next_joints, and the level, to what the state says.
void point_to_state(Instance& instance) noexcept;

}  // namespace sinew::world
