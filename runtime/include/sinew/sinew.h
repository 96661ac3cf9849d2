/* sinew.h  The whole of Sinew for C11 and for whatever can call C. Every function of sinew::World is here,
 * under its own name; what it means, ranges and cost stand there: world.hpp, types.hpp, asset.hpp, read.hpp,
 * parameters.hpp.
 *
 *   sinew_world_def def = sinew_default_world_def();
 *   sinew_world world;
 *   if (sinew_create_world(SINEW_LAYOUT, &def, &world) != SINEW_OK) puts(sinew_message());
 *
 * Worlds, assets and instances are ids, passed by value; one that is all zero is null. A struct whose first
 * field is `made_by` comes from its default function: sinew_default_instance_def() and so on; the others are
 * filled in whole. Spans are a pointer and a count. Hooks are functions with a context; a null function:
 * none.
 *
 * A function that can be refused returns a status; after a refusal nothing has changed, and sinew_message()
 * says why in one line. What returns a count, a pointer or a truth answers 0 to an id of nothing, and leaves
 * no message. Nothing is thrown or aborted across this interface. Threads: as World has it; worlds may be
 * made and destroyed on any thread, a world while none of its functions runs.
 *
 * Lengths are in metres, times in seconds, right-handed, Y up; matrices are row-major 3x4. */
#ifndef SINEW_SINEW_H
#define SINEW_SINEW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "sinew/export.h"
#include "sinew/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- status ---- */

typedef uint32_t sinew_status;
enum {
  SINEW_OK = 0,
  SINEW_INVALID_ARGUMENT = 1,
  SINEW_UNREADABLE = 2,
  SINEW_NOT_A_PACK = 3,
  SINEW_WRONG_VERSION = 4,
  SINEW_TRUNCATED = 5,
  SINEW_CORRUPT = 6,
  SINEW_UNSUPPORTED = 7,
  SINEW_OUT_OF_CAPACITY = 8,
  SINEW_STALE_ID = 9,
  SINEW_NOT_FINITE = 10
};

/* Of the last call on this thread that was refused: what, where, how to mend. Good until the next one. */
SINEW_API const char* sinew_message(void);

/* Of the library: major * 10000 + minor * 100 + patch. SINEW_VERSION is the header's. */
SINEW_API uint32_t sinew_version(void);

/* ---- ids ---- */

typedef struct sinew_world {
  uint32_t index1, generation;
} sinew_world;
typedef struct sinew_asset {
  uint32_t index1, generation;
} sinew_asset;
typedef struct sinew_instance {
  uint32_t index1, generation;
} sinew_instance;

#define SINEW_NONE 0xffffffffu /* no index */

/* ---- the world ---- */

/* Row-major: p' = m[r][0..2] p + m[r][3]. */
typedef struct sinew_matrix34 {
  float m[3][4];
} sinew_matrix34;

typedef struct sinew_root {
  double position_m[3];
  float rotation_xyzw[4];
  double scale;
} sinew_root;

typedef void (*sinew_task)(void* argument, uint32_t index);
typedef struct sinew_task_hook {
  void* (*enqueue)(sinew_task task, void* argument, uint32_t count, void* context);
  void (*finish)(void* ticket, void* context);
  void* context;
} sinew_task_hook;

typedef struct sinew_clock_hook {
  uint64_t (*now_ns)(void* context);
  void* context;
} sinew_clock_hook;

/* Without one, a programmer error (a stale id, a step within a step) is answered by its status alone. */
typedef struct sinew_assert_hook {
  void (*fail)(const char* condition, const char* file, int line, void* context);
  void* context;
} sinew_assert_hook;

typedef struct sinew_profiler_hook {
  void (*begin)(const char* name, uint32_t instance, void* context);
  void (*end)(const char* name, uint32_t instance, void* context);
  void* context;
} sinew_profiler_hook;

/* Whether something hides characters between two points of the world. */
typedef struct sinew_occlusion_source {
  bool (*is_blocked)(const double* from_m, const double* to_m, void* context);
  void* context;
} sinew_occlusion_source;

typedef uint32_t sinew_budget_mode;
enum { SINEW_BUDGET_TIME = 0, SINEW_BUDGET_WORK_UNITS = 1 };

typedef struct sinew_teleport_def {
  float distance, angle_rad, scale, acceleration;
} sinew_teleport_def;

typedef struct sinew_world_def {
  uint32_t made_by;
  uint32_t max_assets, max_instances, max_ticks_per_step;
  sinew_teleport_def teleport;
  float sleep_tolerance;
  uint32_t report_history, event_capacity;
  sinew_budget_mode budget_mode;
  uint32_t sight_rays_per_step;
  sinew_occlusion_source occlusion;
  sinew_task_hook tasks;
  sinew_clock_hook clock;
  sinew_assert_hook assert_hook;
  sinew_profiler_hook profiler;
} sinew_world_def;
SINEW_API sinew_world_def sinew_default_world_def(void);

/* layout: SINEW_LAYOUT, the sizes of this header's structs as the caller's compiler sees them. Another
 * header's, or another packing: SINEW_UNSUPPORTED. 64 worlds at most live at a time. */
SINEW_API sinew_status sinew_create_world(uint32_t layout, const sinew_world_def* def, sinew_world* out);
/* With all that is in it. Once: two threads that destroy the same world are an error. */
SINEW_API sinew_status sinew_destroy_world(sinew_world world);

/* ---- assets ---- */

/* bytes: 64-byte aligned; they outlive the asset. */
SINEW_API sinew_status sinew_load_asset(sinew_world world, const void* bytes, size_t byte_count,
                                        sinew_asset* out);
SINEW_API sinew_status sinew_load_asset_file(sinew_world world, const char* path, sinew_asset* out);
SINEW_API sinew_status sinew_unload_asset(sinew_world world, sinew_asset asset);
/* Its instances go on as those of the same character baked anew. */
SINEW_API sinew_status sinew_replace_asset(sinew_world world, sinew_asset asset, sinew_asset by);

typedef struct sinew_asset_info {
  uint32_t vertex_count, triangle_count, joint_count, region_count, node_count, clip_count;
  uint32_t mesh_count, primitive_count, moved_vertex_count, proxy_count, rod_count;
  bool rod_network;
  uint32_t graph_levels;
  float tick_hz, height_m, unit_m;
  uint64_t instance_bytes;
} sinew_asset_info;

typedef struct sinew_asset_arrays {
  const float* positions_m;       /* [vertices][3] */
  const float* normals;           /* [vertices][3] */
  const float* tangents;          /* [vertices][4]; null: none */
  const uint32_t* triangles;      /* [triangles][3] */
  const uint32_t* moved_vertices; /* [moved_vertex_count], ascending */
  const uint16_t* skin_joints;    /* eight of each vertex, skin_stride_bytes from one vertex to the next */
  const float* skin_weights;      /* the same */
  size_t skin_stride_bytes;
} sinew_asset_arrays;

typedef struct sinew_mesh_info {
  const char* name;
  uint32_t first_vertex, vertex_count, first_primitive, primitive_count;
  sinew_matrix34 mesh_from_bind;
} sinew_mesh_info;

typedef struct sinew_primitive_info {
  uint32_t mesh, index;
  const char* material;
  uint32_t first_vertex, vertex_count, first_triangle, triangle_count;
} sinew_primitive_info;

typedef struct sinew_joint_info {
  const char* name;
  uint32_t parent, rod;
  sinew_matrix34 inverse_bind;
} sinew_joint_info;

typedef struct sinew_region_info {
  const char* name;
  const uint32_t* vertices;
  uint32_t vertex_count, node_count;
  float center_m[3];
  float radius_m, displacement_limit_m, frequency_hz, damping_ratio;
} sinew_region_info;

typedef struct sinew_rod_info {
  const char* name;
  uint32_t attach_joint, end_joint, segment_count;
  float length_m, frequency_hz, gravity, turn_limit_rad, damping_ratio;
} sinew_rod_info;

typedef struct sinew_proxy_info {
  uint32_t joint;
  float from_m[3], to_m[3];
  float radius_m;
} sinew_proxy_info;

typedef struct sinew_clip_info {
  const char* name;
  float duration_s;
  uint32_t frame_count;
  float rate_hz;
} sinew_clip_info;

typedef uint32_t sinew_clip_end;
enum { SINEW_CLIP_HOLD = 0, SINEW_CLIP_LOOP = 1 };

SINEW_API sinew_status sinew_get_asset_info(sinew_world world, sinew_asset asset, sinew_asset_info* out);
SINEW_API sinew_status sinew_get_asset_arrays(sinew_world world, sinew_asset asset, sinew_asset_arrays* out);
SINEW_API sinew_status sinew_get_mesh_info(sinew_world world, sinew_asset asset, uint32_t mesh,
                                           sinew_mesh_info* out);
SINEW_API sinew_status sinew_get_primitive_info(sinew_world world, sinew_asset asset, uint32_t primitive,
                                                sinew_primitive_info* out);
SINEW_API sinew_status sinew_get_joint_info(sinew_world world, sinew_asset asset, uint32_t joint,
                                            sinew_joint_info* out);
SINEW_API sinew_status sinew_get_region_info(sinew_world world, sinew_asset asset, uint32_t region,
                                             sinew_region_info* out);
SINEW_API sinew_status sinew_get_rod_info(sinew_world world, sinew_asset asset, uint32_t rod,
                                          sinew_rod_info* out);
SINEW_API sinew_status sinew_get_proxy_info(sinew_world world, sinew_asset asset, uint32_t proxy,
                                            sinew_proxy_info* out);
SINEW_API sinew_status sinew_get_clip_info(sinew_world world, sinew_asset asset, uint32_t clip,
                                           sinew_clip_info* out);
/* Null for a stale id or a joint that is not there. */
SINEW_API const char* sinew_joint_name(sinew_world world, sinew_asset asset, uint32_t joint);
/* Writes at most `capacity` bytes with the zero; returns the whole length without it. */
SINEW_API size_t sinew_joint_path(sinew_world world, sinew_asset asset, uint32_t joint, char* out,
                                  size_t capacity);
SINEW_API bool sinew_joint_is_on_rod(sinew_world world, sinew_asset asset, uint32_t joint);
/* joint_count: the asset's, else refused; here and wherever joints are handed over. */
SINEW_API sinew_status sinew_bind_pose(sinew_world world, sinew_asset asset, sinew_matrix34* out,
                                       uint32_t joint_count);
SINEW_API sinew_status sinew_sample_clip(sinew_world world, sinew_asset asset, uint32_t clip, double time_s,
                                         sinew_clip_end end, sinew_matrix34* out, uint32_t joint_count);

/* ---- contacts ---- */

typedef struct sinew_contact_probe {
  double start_m[2][3], end_m[2][3];
  float radius_m;
  uint32_t owner;
} sinew_contact_probe;

typedef struct sinew_contact_hit {
  uint32_t probe;
  float along;
  double gap_m;
  float normal[3];
  float velocity_m_s[3];
  float friction, restitution;
  uint32_t name;
  uint64_t body;
} sinew_contact_hit;

/* As sinew::ContactSource (contact_source.hpp): find returns how many contacts there are and writes the first
 * `capacity`; push may be null. Called on the world's threads. */
typedef struct sinew_contact_source {
  uint32_t (*find)(const sinew_contact_probe* probes, uint32_t probe_count, float dt_s,
                   sinew_contact_hit* hits, uint32_t capacity, void* context);
  void (*push)(const sinew_contact_hit* hit, const double* point_m, const float* impulse_n_s, void* context);
  void* context;
} sinew_contact_source;

/* ---- instances ---- */

typedef uint32_t sinew_rod_start;
enum { SINEW_ROD_START_AS_BAKED = 0, SINEW_ROD_START_CONTINUED = 1, SINEW_ROD_START_LEARNED = 2 };

typedef struct sinew_instance_def {
  uint32_t made_by;
  sinew_asset asset;
  float importance;
  sinew_root root;
  sinew_contact_source contacts; /* find null: nothing is asked */
  sinew_contact_source surface;  /* of rods alone: the skin at full resolution */
  uint32_t contact_owner;
  bool tissue_touches, rods_touch, touches_own_body;
  bool report_rod_residual;
  sinew_rod_start rod_start;
  uint32_t max_rod_iterations;
} sinew_instance_def;
SINEW_API sinew_instance_def sinew_default_instance_def(void);

SINEW_API sinew_status sinew_create_instance(sinew_world world, const sinew_instance_def* def,
                                             sinew_instance* out);
SINEW_API sinew_status sinew_destroy_instance(sinew_world world, sinew_instance instance);

typedef struct sinew_pose {
  uint32_t made_by;
  uint32_t joint_count;
  const sinew_matrix34* joints; /* character-from-joint, in the asset's order */
  sinew_root root;              /* world-from-character */
  uint32_t space_id;            /* what it rides on; 0: nothing */
  bool teleport;
  sinew_root space;
} sinew_pose;
SINEW_API sinew_pose sinew_default_pose(void);

SINEW_API sinew_status sinew_set_pose(sinew_world world, sinew_instance instance, const sinew_pose* pose);
SINEW_API sinew_status sinew_skip_pose(sinew_world world, sinew_instance instance);
SINEW_API sinew_status sinew_set_importance(sinew_world world, sinew_instance instance, float importance);
SINEW_API sinew_status sinew_set_hidden(sinew_world world, sinew_instance instance, bool hidden);
/* In rising quality: skinning, extrapolate, modal, network. */
typedef uint32_t sinew_tier;
enum { SINEW_TIER_SKINNING = 0, SINEW_TIER_EXTRAPOLATE = 1, SINEW_TIER_NETWORK = 2, SINEW_TIER_MODAL = 4 };
SINEW_API sinew_status sinew_set_tier_limit(sinew_world world, sinew_instance instance, sinew_tier best);
SINEW_API sinew_status sinew_set_time_scale(sinew_world world, sinew_instance instance, float scale);
SINEW_API sinew_status sinew_set_felt_root_motion(sinew_world world, sinew_instance instance, float share);

/* How it swings, from the next tick on; changes glide (parameters.hpp). Of a part its own numbers times the
 * instance's. */
typedef struct sinew_part_parameters {
  uint32_t made_by;
  float intensity, stiffness, damping, displacement;
  bool enabled;
} sinew_part_parameters;
SINEW_API sinew_part_parameters sinew_default_part_parameters(void);
SINEW_API sinew_status sinew_set_parameters(sinew_world world, sinew_instance instance,
                                            const sinew_part_parameters* of_all);
SINEW_API sinew_status sinew_set_region_parameters(sinew_world world, sinew_instance instance,
                                                   uint32_t region, const sinew_part_parameters* own);
SINEW_API sinew_status sinew_set_rod_parameters(sinew_world world, sinew_instance instance, uint32_t rod,
                                                const sinew_part_parameters* own);
SINEW_API sinew_status sinew_get_parameters(sinew_world world, sinew_instance instance,
                                            sinew_part_parameters* out);
SINEW_API sinew_status sinew_get_region_parameters(sinew_world world, sinew_instance instance,
                                                   uint32_t region, sinew_part_parameters* out);
SINEW_API sinew_status sinew_get_rod_parameters(sinew_world world, sinew_instance instance, uint32_t rod,
                                                sinew_part_parameters* out);

/* What all characters of a world feel beside their motion. */
typedef struct sinew_environment {
  uint32_t made_by;
  float gravity_m_s2[3], acceleration_m_s2[3];
  float wind_m_s[3], gust, gust_hz;
} sinew_environment;
SINEW_API sinew_environment sinew_default_environment(void);
SINEW_API sinew_status sinew_set_environment(sinew_world world, const sinew_environment* environment);
SINEW_API sinew_status sinew_get_environment(sinew_world world, sinew_environment* out);

/* What one instance feels more than that. */
typedef struct sinew_added_environment {
  float acceleration_m_s2[3], wind_m_s[3];
} sinew_added_environment;
SINEW_API sinew_status sinew_set_added_environment(sinew_world world, sinew_instance instance,
                                                   const sinew_added_environment* added);
SINEW_API sinew_status sinew_get_added_environment(sinew_world world, sinew_instance instance,
                                                   sinew_added_environment* out);

SINEW_API sinew_status sinew_reset(sinew_world world, sinew_instance instance);

typedef struct sinew_view {
  uint32_t made_by;
  double position_m[3];
  float rotation_xyzw[4];
  float height_rad, aspect, far_m;
} sinew_view;
SINEW_API sinew_view sinew_default_view(void);
/* At most 8. */
SINEW_API sinew_status sinew_set_views(sinew_world world, const sinew_view* views, uint32_t count);

/* ---- the step ---- */

typedef uint32_t sinew_tier_reason;
enum {
  SINEW_REASON_BEST = 0,
  SINEW_REASON_BUDGET = 1,
  SINEW_REASON_HELD = 2,
  SINEW_REASON_TURN = 3,
  SINEW_REASON_WAITING = 4,
  SINEW_REASON_CUT = 5,
  SINEW_REASON_HIDDEN = 6,
  SINEW_REASON_GUARD = 7,
  SINEW_REASON_STILL = 8
};

typedef struct sinew_frame_report {
  uint64_t frame;
  uint32_t ticks;
  float dropped_s, budget_us, total_us;
  float schedule_us, drive_us, tissue_us, rods_us, publish_us;
  uint32_t instances_network, instances_modal, instances_extrapolated, instances_skinned;
  uint32_t instances_hidden, instances_dormant, instances_cut;
  uint32_t restarts, fallbacks, regions_asleep, rejected_poses;
  float unspent_us, expected_error;
  bool over_budget;
} sinew_frame_report;

typedef struct sinew_instance_report {
  sinew_instance instance;
  sinew_tier tier;
  sinew_tier_reason why;
  float error;
  uint32_t graph_level;
  float blend;
  uint32_t ticks_since_network, input_clamps, displacement_clamps, fallbacks, restarts;
  uint32_t regions_asleep, regions_left_out, teleports, part_teleports;
  uint32_t rod_recoveries, rods_asleep, rod_iterations;
  float rod_residual;
  uint32_t rod_contacts;
  bool rods_touch_surface;
  uint32_t vertices_touched, contacts_refused, contacts_dropped;
  float contact_volume_m3, deepest_penetration_m;
  float cost_us, planned_us;
  bool hidden, dormant;
} sinew_instance_report;

typedef uint32_t sinew_event_kind;
enum {
  SINEW_EVENT_TELEPORT = 0,
  SINEW_EVENT_PART_TELEPORT = 1,
  SINEW_EVENT_NETWORK_GIVEN_UP = 2,
  SINEW_EVENT_RESTART = 3,
  SINEW_EVENT_ROD_RECOVERY = 4
};

typedef struct sinew_event {
  sinew_event_kind kind;
  sinew_instance instance;
  uint64_t frame;
} sinew_event;

SINEW_API sinew_status sinew_set_budget_us(sinew_world world, float budget_us);
/* report: null where nobody looks at it. */
SINEW_API sinew_status sinew_step(sinew_world world, float dt_s, sinew_frame_report* report);
SINEW_API sinew_status sinew_get_report(sinew_world world, sinew_instance instance,
                                        sinew_instance_report* out);
/* These return how many were written. */
SINEW_API size_t sinew_history(sinew_world world, sinew_frame_report* out, size_t capacity);
SINEW_API size_t sinew_take_events(sinew_world world, sinew_event* out, size_t capacity);
SINEW_API uint64_t sinew_events_lost(sinew_world world);

/* ---- what is read back ---- */

typedef uint32_t sinew_space;
enum { SINEW_SPACE_CHARACTER = 0, SINEW_SPACE_WORLD = 1, SINEW_SPACE_BIND = 2 };

typedef uint32_t sinew_vertex_format;
enum { SINEW_FLOAT3 = 0, SINEW_FLOAT4 = 1, SINEW_HALF4 = 2 };

typedef struct sinew_vertex_stream {
  void* out; /* null: not wanted */
  size_t stride_bytes;
  sinew_vertex_format format;
} sinew_vertex_stream;

typedef struct sinew_surface_def {
  uint32_t made_by;
  sinew_space space;
  double origin_m[3];
  bool moved_only;
  size_t capacity; /* vertices */
  sinew_vertex_stream positions, normals, tangents;
} sinew_surface_def;
SINEW_API sinew_surface_def sinew_default_surface_def(void);
SINEW_API sinew_status sinew_read_surface(sinew_world world, sinew_instance instance,
                                          const sinew_surface_def* def);
/* The same, of positions or normals alone, as three floats a vertex, one right behind the other. */
SINEW_API sinew_status sinew_read_positions(sinew_world world, sinew_instance instance, sinew_space space,
                                            float* out, size_t capacity);
SINEW_API sinew_status sinew_read_normals(sinew_world world, sinew_instance instance, sinew_space space,
                                          float* out, size_t capacity);
SINEW_API sinew_status sinew_read_joint_matrices(sinew_world world, sinew_instance instance,
                                                 sinew_matrix34* out, uint32_t joint_count);

typedef struct sinew_surface_place {
  uint32_t triangle;
  float weights[3]; /* sum 1 */
} sinew_surface_place;
/* origin_m: three numbers, subtracted in world space; null: none. */
SINEW_API sinew_status sinew_read_points(sinew_world world, sinew_instance instance, sinew_space space,
                                         const double* origin_m, const sinew_surface_place* places,
                                         size_t count, sinew_matrix34* out);

typedef struct sinew_bounds {
  double center_m[3];
  float radius_m;
} sinew_bounds;
SINEW_API sinew_status sinew_get_bounds(sinew_world world, sinew_instance instance, sinew_bounds* out);

enum {
  SINEW_DEBUG_NODES = 1,
  SINEW_DEBUG_RODS = 2,
  SINEW_DEBUG_PROXIES = 4,
  SINEW_DEBUG_TOUCHES = 8,
  SINEW_DEBUG_BOUNDS = 16,
  SINEW_DEBUG_ALL = 31
};
typedef struct sinew_debug_line {
  float from_m[3], to_m[3];
  uint32_t rgba; /* 0xRRGGBBAA */
} sinew_debug_line;
/* Returns how many there are; writes the first `capacity`. origin_m as above. */
SINEW_API size_t sinew_debug_lines(sinew_world world, sinew_instance instance, uint32_t parts,
                                   const double* origin_m, sinew_debug_line* out, size_t capacity);

/* ---- rollback ---- */

SINEW_API size_t sinew_state_bytes(sinew_world world, sinew_instance instance);
SINEW_API sinew_status sinew_save_state(sinew_world world, sinew_instance instance, void* out,
                                        size_t byte_count);
SINEW_API sinew_status sinew_restore_state(sinew_world world, sinew_instance instance, const void* bytes,
                                           size_t byte_count);

/* ---- instruction sets, of all worlds of the process ---- */

SINEW_API uint32_t sinew_isa_count(void);
SINEW_API const char* sinew_isa_name(uint32_t index); /* best first; null for one that is not there */
SINEW_API const char* sinew_active_isa(void);
SINEW_API sinew_status sinew_force_isa(const char* name);

#define SINEW_LAYOUT                                                                                   \
  ((uint32_t)(SINEW_VERSION + 1u * sizeof(sinew_world_def) + 3u * sizeof(sinew_asset_info) +           \
              5u * sizeof(sinew_asset_arrays) + 7u * sizeof(sinew_mesh_info) +                         \
              11u * sizeof(sinew_primitive_info) + 13u * sizeof(sinew_joint_info) +                    \
              17u * sizeof(sinew_region_info) + 19u * sizeof(sinew_rod_info) +                         \
              23u * sizeof(sinew_proxy_info) + 29u * sizeof(sinew_clip_info) +                         \
              31u * sizeof(sinew_contact_probe) + 37u * sizeof(sinew_contact_hit) +                    \
              41u * sizeof(sinew_instance_def) + 43u * sizeof(sinew_pose) + 47u * sizeof(sinew_view) + \
              53u * sizeof(sinew_frame_report) + 59u * sizeof(sinew_instance_report) +                 \
              61u * sizeof(sinew_event) + 67u * sizeof(sinew_surface_def) +                            \
              71u * sizeof(sinew_surface_place) + 73u * sizeof(sinew_bounds) +                         \
              79u * sizeof(sinew_debug_line) + 83u * sizeof(sinew_part_parameters) +                   \
              89u * sizeof(sinew_environment) + 97u * sizeof(sinew_added_environment)))

#ifdef __cplusplus
}
#endif

#endif
