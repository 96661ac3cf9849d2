// types.hpp  Plain definitions and results of the public API. SI units, right-handed, Y up (glTF 2.0).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "sinew/id.hpp"
#include "sinew/status.hpp"

namespace sinew {

// Row-major 3x4 affine matrix: p' = m[r][0..2] p + m[r][3].
struct Matrix34 {
  float m[3][4];
};

// A double-precision place and a unit quaternion (x y z w), so that a character far from the origin loses nothing.
struct RootTransform {
  double position_m[3] = {0, 0, 0};
  float rotation_xyzw[4] = {0, 0, 0, 1};  // normalised on entry; zero length or NaN: set_pose refuses the pose
};

// One pose of one character. joints: character-from-joint (before the inverse bind matrix), one for each of the
// asset's joints, in the asset's order; fewer, more, or a NaN: refused, and the last good pose stays.
struct Pose {
  std::span<const Matrix34> joints = {};
  RootTransform root = {};  // world-from-character
};

// Threads come from the caller. Contract: enqueue may run task(argument, index) for index 0..count-1 on any threads, in any
// order, each exactly once, and may return at once; finish returns when all of that call's indices have run.
// Both are called from the thread that calls step(). Null enqueue: serial, on that thread.
struct TaskHook {
  using Task = void (*)(void* argument, uint32_t index);
  void* (*enqueue)(Task task, void* argument, uint32_t count, void* context) = nullptr;  // returns a ticket for finish
  void (*finish)(void* ticket, void* context) = nullptr;
  void* context = nullptr;
};

// Monotonic nanoseconds. Null: the steady clock.
struct ClockHook {
  uint64_t (*now_ns)(void* context) = nullptr;
  void* context = nullptr;
};

// Called for programmer errors (a stale id, a second step inside a step). Null: abort in debug builds, ignore in release.
struct AssertHook {
  void (*fail)(const char* condition, const char* file, int line, void* context) = nullptr;
  void* context = nullptr;
};

enum class BudgetMode : uint32_t {
  kTime = 0,       // budget_us is microseconds of the stepping thread's clock; costs are corrected online
  kWorkUnits = 1,  // budget_us is baked microseconds: the same inputs give the same tiers and bits on any machine
};

struct WorldDef {
  uint32_t max_assets = 16;       // 1..65535; one more load is refused with kOutOfCapacity
  uint32_t max_instances = 64;    // 1..100000; one more create is refused with kOutOfCapacity
  uint32_t max_ticks_per_step = 4;  // 1..64; a longer frame drops the excess time and reports it
  float teleport_distance_m = 2;  // > 0; a root that moves further between two ticks is a teleport: tissue keeps its shape
  BudgetMode budget_mode = BudgetMode::kTime;
  TaskHook tasks = {};
  ClockHook clock = {};
  AssertHook assert_hook = {};
};

struct InstanceDef {
  AssetId asset = {};          // null or stale: refused
  float importance = 1;   // >= 0, relative weight for the scheduler; NaN or negative counts as 0
  RootTransform root = {};     // where it enters, in its bind pose, at rest
};

// What an instance got in a frame. Values are baked into packs: never renumbered.
enum class Tier : uint32_t {
  kSkinning = 0,     // displacement faded to zero
  kExtrapolate = 1,  // the last displacement carried on, damped
  kNetwork = 2,      // the asset's network
};

struct InstanceReport {
  InstanceId instance = {};
  Tier tier = Tier::kSkinning;
  float blend = 0;                   // 0..1, weight of the simulated displacement in what is read back
  uint32_t ticks_since_network = 0;  // 0: evaluated this frame
  uint32_t input_clamps = 0;         // network inputs outside the baked envelope, since creation
  uint32_t displacement_clamps = 0;  // nodes held at the baked displacement bound, since creation
  uint32_t restarts = 0;             // times the state was faded to skinning and restarted (NaN, envelope), since creation
  float cost_us = 0;                 // what this instance took in this frame
};

// Filled by step(). All times in microseconds of the world's clock.
struct FrameReport {
  uint64_t frame = 0;
  uint32_t ticks = 0;         // fixed ticks simulated
  float dropped_s = 0;        // time beyond max_ticks_per_step, not simulated
  float budget_us = 0;        // as set; infinity: no limit
  float total_us = 0;         // the whole step
  float schedule_us = 0, drive_us = 0, tissue_us = 0, publish_us = 0;
  uint32_t instances_network = 0, instances_extrapolated = 0, instances_skinned = 0;
  uint32_t instances_cut = 0;    // scheduled for the network, but the deadline came first: extrapolated instead
  uint32_t restarts = 0;         // instances restarted in this frame
  uint32_t rejected_poses = 0;   // set_pose calls refused since the last step
  bool over_budget = false;      // total_us > budget_us
};

// Where positions are written and in which space.
enum class Space : uint32_t {
  kCharacter = 0,  // the pose's character space
  kWorld = 1,      // root applied, relative to origin_m below
  kBind = 2,       // bind-space displacement (a delta, not a place): add it to the bind position before GPU skinning
};

struct ReadDef {
  Space space = Space::kCharacter;
  double origin_m[3] = {0, 0, 0};  // kWorld: subtracted in double before rounding to float
  float* out = nullptr;            // first vertex's x; y and z follow it
  size_t stride_bytes = 12;        // >= 12, a multiple of 4
  size_t capacity = 0;             // vertices that fit; fewer than the asset's vertex_count: refused, nothing written
};

struct AssetInfo {
  uint32_t vertex_count = 0, triangle_count = 0, joint_count = 0, region_count = 0, node_count = 0, clip_count = 0;
  float tick_hz = 0;
  float height_m = 0;  // extent of the bind pose along Y
  uint64_t instance_bytes = 0;  // memory one instance takes
};

}  // namespace sinew
