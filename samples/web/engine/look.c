/* look.c  What the page reads of the last step. */
#include <math.h>

#include "state.h"

/* A place on the skin as its first joint moves it. */
static void place_of(uint32_t figure, uint32_t vertex, float* out_m) {
  const char* joints = (const char*)now->arrays.skin_joints;
  const uint16_t joint = *(const uint16_t*)(const void*)(joints + vertex * now->arrays.skin_stride_bytes);
  const sinew_matrix34* m = &now->shown[(size_t)figure * now->info.joint_count + joint];
  const float* bind = now->arrays.positions_m + 3 * (size_t)vertex;
  for (int k = 0; k < 3; ++k)
    out_m[k] = m->m[k][0] * bind[0] + m->m[k][1] * bind[1] + m->m[k][2] * bind[2] + m->m[k][3];
}

/* How far along the ray a place lies; infinite: not near it. */
static float along_ray(const float* place_m, const float* from_m, const float* to, float near_m) {
  float along = 0, off2 = 0;
  for (int k = 0; k < 3; ++k) along += (place_m[k] - from_m[k]) * to[k];
  for (int k = 0; k < 3; ++k) {
    const float off = place_m[k] - from_m[k] - along * to[k];
    off2 += off * off;
  }
  return along > 0 && off2 < near_m * near_m ? along : INFINITY;
}

static float picked_m;

int32_t scene_pick(float x, float y, float z, float to_x, float to_y, float to_z) {
  const float from_m[3] = {x, y, z}, to[3] = {to_x, to_y, to_z};
  int32_t best = -1;
  float best_along = INFINITY;
  for (uint32_t i = 0; now && i < now->figure_count; ++i) {
    const uint32_t stride = now->info.vertex_count / 400 + 1;
    for (uint32_t v = 0; v < now->info.vertex_count; v += stride) {
      float place_m[3];
      place_of(i, v, place_m);
      const float along = along_ray(place_m, from_m, to, 0.06f * now->info.height_m);
      if (along < best_along) best = (int32_t)i, best_along = along;
    }
  }
  picked_m = best_along;
  return best;
}

float scene_picked_m(void) { return picked_m; }

const float* scene_posed_joints(void) { return now ? &now->posed[0].m[0][0] : NULL; }
const float* scene_shown_joints(void) { return now ? &now->shown[0].m[0][0] : NULL; }
const uint16_t* scene_displacements(void) { return now ? now->displacements : NULL; }
const uint16_t* scene_normals(void) { return now ? now->normals : NULL; }
const uint8_t* scene_tiers(void) { return now ? &now->tiers[0][0] : NULL; }
const float* scene_report(void) { return now ? now->report : NULL; }

const float* scene_positions(uint32_t figure) {
  if (!now || figure >= now->figure_count) return NULL;
  const sinew_status status = sinew_read_positions(now->world, now->figures[figure].instance,
                                                   SINEW_SPACE_WORLD, now->positions, now->info.vertex_count);
  return status ? NULL : now->positions;
}

uint32_t scene_draw_lines(uint32_t parts) {
  static const double origin_m[3] = {0, 0, 0};
  size_t count = 0;
  for (uint32_t i = 0; now && parts && i < now->figure_count && count < MOST_LINES; ++i) {
    const size_t left = MOST_LINES - count;
    const size_t there =
        sinew_debug_lines(now->world, now->figures[i].instance, parts, origin_m, now->lines + count, left);
    count += there < left ? there : left;
  }
  return (uint32_t)count;
}

const void* scene_lines(void) { return now ? now->lines : NULL; }
