/* set.c  What the page sets between steps. */
#include <math.h>

#include "state.h"

wishes wish = {.budget_us = INFINITY, .held = -1};

uint32_t scene_set_clip(int32_t clip) {
  if (!now || clip < SCENE_TURNING || clip >= (int32_t)now->info.clip_count)
    return refuse(SINEW_INVALID_ARGUMENT, "there is no such clip");
  wish.clip = clip;
  return SINEW_OK;
}

uint32_t scene_set_budget_us(float budget_us) {
  forget_refusal();
  const sinew_status status = now ? sinew_set_budget_us(now->world, budget_us) : SINEW_OK;
  if (!status) wish.budget_us = budget_us;
  return status;
}

uint32_t scene_set_best_tier(uint32_t tier) {
  forget_refusal();
  sinew_status status = SINEW_OK;
  for (uint32_t i = 0; now && i < now->figure_count && !status; ++i)
    status = sinew_set_tier_limit(now->world, now->figures[i].instance, tier);
  return status;
}

uint32_t scene_set_part(uint32_t kind, uint32_t index, float intensity, float stiffness, float damping,
                        float displacement, uint32_t enabled) {
  forget_refusal();
  sinew_part_parameters part = sinew_default_part_parameters();
  part.intensity = intensity, part.stiffness = stiffness, part.damping = damping;
  part.displacement = displacement, part.enabled = enabled != 0;
  sinew_status status = SINEW_OK;
  for (uint32_t i = 0; now && i < now->figure_count && !status; ++i) {
    const sinew_instance instance = now->figures[i].instance;
    if (kind == SCENE_ALL) status = sinew_set_parameters(now->world, instance, &part);
    if (kind == SCENE_REGION) status = sinew_set_region_parameters(now->world, instance, index, &part);
    if (kind == SCENE_ROD) status = sinew_set_rod_parameters(now->world, instance, index, &part);
  }
  return status;
}

uint32_t scene_set_air(float gravity_m_s2, float wind_x_m_s, float wind_y_m_s, float wind_z_m_s, float gust,
                       float gust_hz) {
  forget_refusal();
  if (!now) return SINEW_OK;
  sinew_environment air = sinew_default_environment();
  air.gravity_m_s2[1] = -gravity_m_s2;
  air.wind_m_s[0] = wind_x_m_s, air.wind_m_s[1] = wind_y_m_s, air.wind_m_s[2] = wind_z_m_s;
  air.gust = gust, air.gust_hz = gust_hz;
  return sinew_set_environment(now->world, &air);
}

uint32_t scene_set_view(double x_m, double y_m, double z_m, float qx, float qy, float qz, float qw,
                        float height_rad, float aspect) {
  forget_refusal();
  if (!now) return SINEW_OK;
  sinew_view view = sinew_default_view();
  view.position_m[0] = x_m, view.position_m[1] = y_m, view.position_m[2] = z_m;
  view.rotation_xyzw[0] = qx, view.rotation_xyzw[1] = qy, view.rotation_xyzw[2] = qz,
  view.rotation_xyzw[3] = qw;
  view.height_rad = height_rad, view.aspect = aspect;
  return sinew_set_views(now->world, &view, 1);
}

void scene_pull(uint32_t figure, float x_m, float y_m, float z_m) {
  wish.held = (int32_t)figure;
  wish.pull_m[0] = (double)x_m, wish.pull_m[1] = (double)y_m, wish.pull_m[2] = (double)z_m;
}

void scene_let_go(void) { wish.held = -1; }

void scene_set_ball(float x_m, float y_m, float z_m, float radius_m) {
  wish.ball_m[0] = (double)x_m, wish.ball_m[1] = (double)y_m, wish.ball_m[2] = (double)z_m;
  if (the_ball.radius_m == 0)
    for (int k = 0; k < 3; ++k) ball_glide.at_m[k] = wish.ball_m[k], ball_glide.speed_m_s[k] = 0;
  the_ball.radius_m = radius_m;
}
