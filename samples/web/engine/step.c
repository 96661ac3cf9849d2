/* step.c  The engine's loop: poses, one step, what the GPU is given. */
#include <math.h>
#include <string.h>

#include "state.h"

/* What is pulled follows the hand, and comes home, as fast as no teleport is. */
static const double kPull_hz = 2.2, kHome_hz = 1.1, kBall_hz = 3;
static const double kShake_hz = 1.4, kTurn_hz = 0.35;

ball the_ball;
glide ball_glide;

static sinew_matrix34 product(const sinew_matrix34* a, const sinew_matrix34* b) {
  sinew_matrix34 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      out.m[r][c] = a->m[r][0] * b->m[0][c] + a->m[r][1] * b->m[1][c] + a->m[r][2] * b->m[2][c] +
                    (c == 3 ? a->m[r][3] : 0);
  return out;
}

static void move_root(const figure* f, sinew_root* root) {
  for (int k = 0; k < 3; ++k) root->position_m[k] = f->home_m[k] + f->pulled.at_m[k];
  const double turns = now->time_s + f->later_s, height_m = (double)now->info.height_m;
  if (wish.clip == SCENE_SHAKEN)
    root->position_m[1] += 0.06 * height_m * (1 - cos(6.283185307179586 * kShake_hz * turns));
  if (wish.clip == SCENE_TURNING) {
    const double half = 0.6 * sin(6.283185307179586 * kTurn_hz * turns);
    root->rotation_xyzw[1] = (float)sin(half), root->rotation_xyzw[3] = (float)cos(half);
  }
}

static sinew_matrix34 matrix_of(const sinew_root* root) {
  const float s = root->rotation_xyzw[1], c = root->rotation_xyzw[3]; /* about y alone */
  const float cosine = c * c - s * s, sine = 2 * s * c;
  return (sinew_matrix34){{{cosine, 0, sine, (float)root->position_m[0]},
                           {0, 1, 0, (float)root->position_m[1]},
                           {-sine, 0, cosine, (float)root->position_m[2]}}};
}

static void to_world_from_bind(const sinew_root* root, const sinew_matrix34* joints, sinew_matrix34* out) {
  const sinew_matrix34 world = matrix_of(root);
  for (uint32_t j = 0; j < now->info.joint_count; ++j) {
    const sinew_matrix34 placed = product(&joints[j], &now->inverse_bind[j]);
    out[j] = product(&world, &placed);
  }
}

static sinew_status pose(uint32_t index, double dt_s) {
  figure* f = &now->figures[index];
  static const double home[3] = {0, 0, 0};
  const int held = wish.held == (int32_t)index;
  glide_to(&f->pulled, held ? wish.pull_m : home, held ? kPull_hz : kHome_hz, dt_s);
  sinew_status status = SINEW_OK;
  if (wish.clip >= 0 && wish.clip < (int32_t)now->info.clip_count)
    status = sinew_sample_clip(now->world, now->asset, (uint32_t)wish.clip, now->time_s + f->later_s,
                               SINEW_CLIP_LOOP, now->joints, now->info.joint_count);
  else
    status = sinew_bind_pose(now->world, now->asset, now->joints, now->info.joint_count);
  if (status) return status;
  sinew_pose pose = sinew_default_pose();
  pose.joints = now->joints;
  pose.joint_count = now->info.joint_count;
  move_root(f, &pose.root);
  to_world_from_bind(&pose.root, now->joints, now->posed + (size_t)index * now->info.joint_count);
  return sinew_set_pose(now->world, f->instance, &pose);
}

static sinew_status read(uint32_t index) {
  const figure* f = &now->figures[index];
  const size_t joints = now->info.joint_count, moved = now->info.moved_vertex_count;
  sinew_status status =
      sinew_read_joint_matrices(now->world, f->instance, now->joints, now->info.joint_count);
  if (status) return status;
  sinew_root root = sinew_default_pose().root;
  move_root(f, &root);
  to_world_from_bind(&root, now->joints, now->shown + index * joints);
  sinew_instance_report told;
  if ((status = sinew_get_report(now->world, f->instance, &told))) return status;
  now->tiers[index][0] = (uint8_t)told.tier, now->tiers[index][1] = (uint8_t)told.why;
  if (moved == 0) return SINEW_OK;
  sinew_surface_def def = sinew_default_surface_def();
  def.space = SINEW_SPACE_BIND;
  def.moved_only = true;
  def.capacity = moved;
  def.positions = (sinew_vertex_stream){now->displacements + 4 * index * moved, 8, SINEW_HALF4};
  if (index == 0) def.normals = (sinew_vertex_stream){now->normals, 8, SINEW_HALF4};
  return sinew_read_surface(now->world, f->instance, &def);
}

static void move_ball(double dt_s) {
  glide before = ball_glide;
  glide_to(&ball_glide, wish.ball_m, kBall_hz, dt_s);
  for (int k = 0; k < 3; ++k) {
    the_ball.at_m[k] = ball_glide.at_m[k];
    the_ball.velocity_m_s[k] = dt_s > 0 ? (float)((ball_glide.at_m[k] - before.at_m[k]) / dt_s) : 0;
  }
}

static void keep_report(const sinew_frame_report* told) {
  const float numbers[REPORT_NUMBERS] = {told->total_us,
                                         told->expected_error,
                                         (float)told->instances_network,
                                         (float)told->instances_modal,
                                         (float)told->instances_extrapolated,
                                         (float)told->instances_skinned,
                                         (float)told->instances_hidden,
                                         (float)told->instances_dormant,
                                         (float)told->instances_cut,
                                         (float)the_ball.at_m[0],
                                         (float)the_ball.at_m[1],
                                         (float)the_ball.at_m[2]};
  memcpy(now->report, numbers, sizeof now->report);
}

uint32_t scene_step(float dt_s) {
  if (!now) return SINEW_OK;
  forget_refusal();
  const double step_s = dt_s > 0 ? (double)dt_s : 0;
  now->time_s += step_s;
  move_ball(step_s);
  sinew_status status = SINEW_OK;
  for (uint32_t i = 0; i < now->figure_count && !status; ++i) status = pose(i, step_s);
  sinew_frame_report told;
  if (!status) status = sinew_step(now->world, dt_s, &told);
  if (status) return status;
  keep_report(&told);
  for (uint32_t i = 0; i < now->figure_count && !status; ++i) status = read(i);
  return status;
}

uint32_t scene_restart(void) {
  forget_refusal();
  if (now) now->time_s = 0;
  for (uint32_t i = 0; now && i < now->figure_count; ++i) {
    memset(&now->figures[i].pulled, 0, sizeof now->figures[i].pulled);
    const sinew_status status = sinew_reset(now->world, now->figures[i].instance);
    if (status) return status;
  }
  return SINEW_OK;
}
