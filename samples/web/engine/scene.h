/* scene.h  The engine's side of the page: a crowd of one character on a floor, beside a ball. Flat functions
 * of numbers and addresses, for that is what a page can call; one scene at a time. What is refused (a status
 * other than 0) changes nothing, and scene_message() says why. Metres, seconds, Y up. */
#ifndef SINEW_WEB_SCENE_H
#define SINEW_WEB_SCENE_H

#include <stdint.h>

/* What the page calls: CMake reads these lines. */
#define SCENE_API

enum { SCENE_MOST_FIGURES = 256 };
/* Instead of a clip's index. */
enum { SCENE_STILL = -1, SCENE_SHAKEN = -2, SCENE_TURNING = -3 };
/* What they touch: scene_open. */
enum { SCENE_TOUCH_BODY = 1, SCENE_TOUCH_BALL = 2 };
/* What scene_set_part speaks of. */
enum { SCENE_ALL = 0, SCENE_REGION = 1, SCENE_ROD = 2 };

/* Memory for a pack; the next scene_open takes it, whatever comes of it. Null: there is none. */
SCENE_API void* scene_pack_bytes(uint32_t byte_count);
/* A new scene of the pack: figures 1..SCENE_MOST_FIGURES, in rows; touches: SCENE_TOUCH_*. */
SCENE_API uint32_t scene_open(uint32_t figures, uint32_t touches);
/* The same pack anew. */
SCENE_API uint32_t scene_change(uint32_t figures, uint32_t touches);
SCENE_API const char* scene_message(void);
/* What the pack holds, as JSON: counts, names, and addresses of its arrays (describe.c). */
SCENE_API const char* scene_description(void);

SCENE_API uint32_t scene_set_clip(int32_t clip);
/* Infinity: no limit. */
SCENE_API uint32_t scene_set_budget_us(float budget_us);
/* Of all figures: a sinew_tier. */
SCENE_API uint32_t scene_set_best_tier(uint32_t tier);
/* Of all figures; the numbers are those of sinew_part_parameters. */
SCENE_API uint32_t scene_set_part(uint32_t kind, uint32_t index, float intensity, float stiffness,
                                  float damping, float displacement, uint32_t enabled);
SCENE_API uint32_t scene_set_air(float gravity_m_s2, float wind_x_m_s, float wind_y_m_s, float wind_z_m_s,
                                 float gust, float gust_hz);
/* Where it is seen from, and how much of it (height_rad: of the view, upright). */
SCENE_API uint32_t scene_set_view(double x_m, double y_m, double z_m, float qx, float qy, float qz, float qw,
                                  float height_rad, float aspect);

/* The figure that a ray meets first, -1: none; and how far along it. to: a unit vector. */
SCENE_API int32_t scene_pick(float x, float y, float z, float to_x, float to_y, float to_z);
SCENE_API float scene_picked_m(void);
/* A figure is pulled this far from its place; let go, it returns. */
SCENE_API void scene_pull(uint32_t figure, float x_m, float y_m, float z_m);
SCENE_API void scene_let_go(void);
SCENE_API void scene_set_ball(float x_m, float y_m, float z_m, float radius_m);

/* Poses, steps, and reads for the addresses below. */
SCENE_API uint32_t scene_step(float dt_s);
/* From the first frame of the clip, at rest. */
SCENE_API uint32_t scene_restart(void);

/* Of the last step. [figures][joints][3][4], world-from-bind: as the clip has them, and with rods. */
SCENE_API const float* scene_posed_joints(void);
SCENE_API const float* scene_shown_joints(void);
/* [figures][moved vertices][4] halves: bind-space displacements; normals of the first figure alone. */
SCENE_API const uint16_t* scene_displacements(void);
SCENE_API const uint16_t* scene_normals(void);
/* [figures][2]: tier, reason. */
SCENE_API const uint8_t* scene_tiers(void);
/* us of the step, expected error; numbers of figures: network, modes, extrapolated, skinned, out of view,
 * asleep, cut; ball x, y, z. */
SCENE_API const float* scene_report(void);
/* [vertices][3], world, of one figure; null: there is none. */
SCENE_API const float* scene_positions(uint32_t figure);
/* Lines of SINEW_DEBUG_* of all figures; scene_lines has them: six floats and a colour each. */
SCENE_API uint32_t scene_draw_lines(uint32_t parts);
SCENE_API const void* scene_lines(void);

#endif
