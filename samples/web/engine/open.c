/* open.c  A scene is made of a pack, and freed. */
#include <math.h>
#include <stdlib.h>

#include "describe.h"
#include "state.h"

scene* now;
static void* pending;
static uint32_t pending_bytes;
static const char* own_message;

uint32_t refuse(sinew_status status, const char* message) {
  own_message = message;
  return status;
}

void forget_refusal(void) { own_message = NULL; }

const char* scene_message(void) { return own_message ? own_message : sinew_message(); }

static void free_scene(scene* s) {
  if (!s) return;
  if (s->world.index1) sinew_destroy_world(s->world);
  free(s->description);
  free(s->inverse_bind), free(s->joints), free(s->posed), free(s->shown);
  free(s->displacements), free(s->normals), free(s->positions), free(s->lines);
  free(s);
}

static int take_memory(scene* s) {
  const size_t joints = s->info.joint_count, moved = s->info.moved_vertex_count;
  s->inverse_bind = calloc(joints, sizeof *s->inverse_bind);
  s->joints = calloc(joints, sizeof *s->joints);
  s->posed = calloc(s->figure_count * joints, sizeof *s->posed);
  s->shown = calloc(s->figure_count * joints, sizeof *s->shown);
  s->displacements = calloc(4 * (s->figure_count * moved + 1), sizeof *s->displacements);
  s->normals = calloc(4 * (moved + 1), sizeof *s->normals);
  s->positions = calloc(3 * (size_t)s->info.vertex_count, sizeof *s->positions);
  s->lines = calloc(MOST_LINES, sizeof *s->lines);
  return s->inverse_bind && s->joints && s->posed && s->shown && s->displacements && s->normals &&
         s->positions && s->lines;
}

/* Rows of a square, the first figure in the middle of the front one. */
static void place(scene* s, uint32_t index) {
  const uint32_t across = (uint32_t)ceil(sqrt(s->figure_count));
  const uint32_t column = index % across, row = index / across;
  const double apart_m = 1.1 * (double)s->info.height_m;
  const int32_t side = (int32_t)((column + 1) / 2) * (column % 2 ? 1 : -1);
  figure* f = &s->figures[index];
  f->home_m[0] = apart_m * side;
  f->home_m[2] = -apart_m * row;
  f->later_s = 0.37 * index;
}

static sinew_status make_figure(scene* s, uint32_t index, uint32_t touches) {
  sinew_instance_def def = sinew_default_instance_def();
  figure* f = &s->figures[index];
  place(s, index);
  def.asset = s->asset;
  for (int k = 0; k < 3; ++k) def.root.position_m[k] = f->home_m[k];
  def.contact_owner = index;
  def.touches_own_body = (touches & SCENE_TOUCH_BODY) != 0;
  if (touches & SCENE_TOUCH_BALL) {
    def.contacts.find = find_obstacles;
    def.contacts.context = &the_ball;
  }
  return sinew_create_instance(s->world, &def, &f->instance);
}

static sinew_status fill(scene* s, uint32_t touches) {
  sinew_world_def def = sinew_default_world_def();
  def.max_instances = SCENE_MOST_FIGURES;
  sinew_status status = sinew_create_world(SINEW_LAYOUT, &def, &s->world);
  if (!status) status = sinew_load_asset(s->world, s->pack, s->pack_bytes, &s->asset);
  if (!status) status = sinew_get_asset_info(s->world, s->asset, &s->info);
  if (!status) status = sinew_get_asset_arrays(s->world, s->asset, &s->arrays);
  if (status) return status;
  if (!take_memory(s) || !(s->description = describe(s->world, s->asset)))
    return refuse(SINEW_OUT_OF_CAPACITY, "the browser gives no more memory; show fewer figures");
  for (uint32_t j = 0; j < s->info.joint_count; ++j) {
    sinew_joint_info joint;
    if ((status = sinew_get_joint_info(s->world, s->asset, j, &joint))) return status;
    s->inverse_bind[j] = joint.inverse_bind;
  }
  for (uint32_t i = 0; i < s->figure_count && !status; ++i) status = make_figure(s, i, touches);
  if (!status) status = sinew_bind_pose(s->world, s->asset, s->joints, s->info.joint_count);
  return status ? status : sinew_set_budget_us(s->world, wish.budget_us);
}

static uint32_t replace(void* pack, uint32_t byte_count, uint32_t figures, uint32_t touches) {
  forget_refusal();
  if (figures < 1 || figures > SCENE_MOST_FIGURES)
    return refuse(SINEW_INVALID_ARGUMENT, "figures is not in 1..256");
  scene* s = calloc(1, sizeof *s);
  if (!s) return refuse(SINEW_OUT_OF_CAPACITY, "the browser gives no more memory; show fewer figures");
  s->pack = pack, s->pack_bytes = byte_count, s->figure_count = figures;
  const sinew_status status = fill(s, touches);
  if (status) return free_scene(s), status;
  free_scene(now);
  now = s;
  wish.held = -1;
  return SINEW_OK;
}

void* scene_pack_bytes(uint32_t byte_count) {
  free(pending);
  const size_t lines = ((size_t)byte_count + 63) / 64;
  pending = lines ? aligned_alloc(64, 64 * lines) : NULL;
  pending_bytes = pending ? byte_count : 0;
  return pending;
}

uint32_t scene_open(uint32_t figures, uint32_t touches) {
  void* pack = pending;
  if (!pack) return refuse(SINEW_OUT_OF_CAPACITY, "the file is empty, or larger than the browser's memory");
  void* old = now ? now->pack : NULL;
  pending = NULL;
  const uint32_t status = replace(pack, pending_bytes, figures, touches);
  free(status ? pack : old);
  return status;
}

uint32_t scene_change(uint32_t figures, uint32_t touches) {
  if (!now) return refuse(SINEW_INVALID_ARGUMENT, "there is no character yet");
  return replace(now->pack, now->pack_bytes, figures, touches);
}

const char* scene_description(void) { return now ? now->description : ""; }
