/* obstacles.c  see obstacles.h. */
#include "obstacles.h"

#include <math.h>
#include <stddef.h>

static const float kFriction = 0.5f;
/* What is nearer than this at the step's end is told of. */
static const double kNear_m = 0.05;

typedef struct found {
  sinew_contact_hit* hits;
  uint32_t capacity, count;
} found;

static void tell(found* found, const sinew_contact_hit* hit) {
  if (found->count < found->capacity) found->hits[found->count] = *hit;
  ++found->count;
}

static void find_floor(const sinew_contact_probe* probe, uint32_t index, found* found) {
  for (uint32_t end = 0; end < 2; ++end) {
    if (probe->end_m[end][1] - (double)probe->radius_m > kNear_m) continue;
    const sinew_contact_hit hit = {.probe = index,
                                   .along = end ? 1.0f : -1.0f,
                                   .gap_m = probe->start_m[end][1] - (double)probe->radius_m,
                                   .normal = {0, 1, 0},
                                   .friction = kFriction,
                                   .name = 1 + end};
    tell(found, &hit);
  }
}

static void find_ball(const ball* ball, const sinew_contact_probe* probe, uint32_t index, double dt_s,
                      found* found) {
  double axis[3], to_ball[3], length2 = 0, along = 0;
  for (int k = 0; k < 3; ++k) {
    axis[k] = probe->end_m[1][k] - probe->end_m[0][k];
    to_ball[k] = ball->at_m[k] - probe->end_m[0][k];
    length2 += axis[k] * axis[k], along += axis[k] * to_ball[k];
  }
  const double share = length2 > 0 ? fmin(1, fmax(0, along / length2)) : 0;
  double out[3], distance2 = 0;
  for (int k = 0; k < 3; ++k) out[k] = share * axis[k] - to_ball[k], distance2 += out[k] * out[k];
  const double distance = sqrt(distance2), both = (double)ball->radius_m + (double)probe->radius_m;
  if (distance - both > kNear_m || !(distance > 0)) return;
  sinew_contact_hit hit = {
      .probe = index, .along = (float)(2 * share - 1), .gap_m = -both, .friction = kFriction, .name = 3};
  for (int k = 0; k < 3; ++k) {
    const double normal = out[k] / distance, was = ball->at_m[k] - dt_s * (double)ball->velocity_m_s[k];
    const double start = (1 - share) * probe->start_m[0][k] + share * probe->start_m[1][k];
    hit.gap_m += normal * (start - was);
    hit.normal[k] = (float)normal;
    hit.velocity_m_s[k] = ball->velocity_m_s[k];
  }
  tell(found, &hit);
}

uint32_t find_obstacles(const sinew_contact_probe* probes, uint32_t probe_count, float dt_s,
                        sinew_contact_hit* hits, uint32_t capacity, void* context) {
  const ball* the_ball = context;
  found found = {hits, capacity, 0};
  for (uint32_t i = 0; i < probe_count; ++i) {
    find_floor(&probes[i], i, &found);
    if (the_ball->radius_m > 0) find_ball(the_ball, &probes[i], i, (double)dt_s, &found);
  }
  return found.count;
}
