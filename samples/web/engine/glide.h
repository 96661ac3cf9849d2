/* glide.h  A place that follows another without a jump of its speed. */
#ifndef SINEW_WEB_GLIDE_H
#define SINEW_WEB_GLIDE_H

#include <math.h>

typedef struct glide {
  double at_m[3], speed_m_s[3];
} glide;

/* Critically damped, exact for any dt_s. */
static inline void glide_to(glide* glide, const double target_m[3], double rate_hz, double dt_s) {
  const double omega = 6.283185307179586 * rate_hz, left = exp(-omega * dt_s);
  for (int k = 0; k < 3; ++k) {
    const double off = glide->at_m[k] - target_m[k], slope = glide->speed_m_s[k] + omega * off;
    glide->at_m[k] = target_m[k] + (off + slope * dt_s) * left;
    glide->speed_m_s[k] = (slope - omega * (off + slope * dt_s)) * left;
  }
}

#endif
