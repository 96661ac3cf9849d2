// spring.cpp  Every control node on a damped spring of its own.
#include "tissue/spring.hpp"

#include <cstddef>

namespace sinew::tissue {

void spring_step(const pack::SpringRecord& spring, const float* compliance, const float* felt,
                 uint32_t stride, uint32_t count, float* u, float* u_before) noexcept {
  for (uint32_t i = 0; i < count; ++i, compliance += 9, felt += stride, u += 3, u_before += 3) {
    float next[3];
    for (int k = 0; k < 3; ++k) {
      const float* row = compliance + 3 * k;
      const float at_rest = row[0] * felt[0] + row[1] * felt[1] + row[2] * felt[2];
      next[k] = spring.a1 * u[k] + spring.a2 * u_before[k] + spring.gain * at_rest;
    }
    for (int k = 0; k < 3; ++k) {
      u_before[k] = u[k];
      u[k] = next[k];
    }
  }
}

}  // namespace sinew::tissue
