/* state.h  What the files of the scene share: the scene, what the page has set, and what was told last. */
#ifndef SINEW_WEB_STATE_H
#define SINEW_WEB_STATE_H

#include <sinew/sinew.h>

#include "glide.h"
#include "obstacles.h"
#include "scene.h"

enum { REPORT_NUMBERS = 12, MOST_LINES = 20000 };

typedef struct figure {
  sinew_instance instance;
  double home_m[3];
  double later_s;
  glide pulled;
} figure;

typedef struct scene {
  void* pack;
  uint32_t pack_bytes;
  sinew_world world;
  sinew_asset asset;
  sinew_asset_info info;
  sinew_asset_arrays arrays;
  char* description;
  figure figures[SCENE_MOST_FIGURES];
  uint32_t figure_count;
  double time_s;
  sinew_matrix34 *inverse_bind, *joints;
  sinew_matrix34 *posed, *shown; /* [figures][joints] */
  uint16_t *displacements, *normals;
  float* positions;
  sinew_debug_line* lines;
  uint8_t tiers[SCENE_MOST_FIGURES][2];
  float report[REPORT_NUMBERS];
} scene;

/* What the page has set, for whatever scene there is. */
typedef struct wishes {
  int32_t clip;
  float budget_us;
  int32_t held; /* a figure; -1: none */
  double pull_m[3];
  double ball_m[3];
} wishes;

extern scene* now; /* null: none yet */
extern wishes wish;
extern ball the_ball;
extern glide ball_glide;

/* The message of a refusal by the scene itself; null: the library's own counts. */
uint32_t refuse(sinew_status status, const char* message);
void forget_refusal(void);

#endif
