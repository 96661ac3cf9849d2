/* obstacles.h  The floor and a ball, as an engine's collision detection answers with them. */
#ifndef SINEW_WEB_OBSTACLES_H
#define SINEW_WEB_OBSTACLES_H

#include <sinew/sinew.h>

typedef struct ball {
  double at_m[3]; /* where the step ends */
  float velocity_m_s[3];
  float radius_m; /* 0: there is none */
} ball;

/* context: a ball. The floor is y = 0. */
uint32_t find_obstacles(const sinew_contact_probe* probes, uint32_t probe_count, float dt_s,
                        sinew_contact_hit* hits, uint32_t capacity, void* context);

#endif
