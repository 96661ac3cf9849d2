// check_hit.hpp  What a contact source answered, before anybody believes it.
#pragma once
#include <cmath>
#include <cstddef>

#include "sinew/contact_source.hpp"

namespace sinew::core {

// Every number in its range (sinew/contact_source.hpp), of a question with so many probes.
inline bool is_usable(const ContactHit& hit, size_t probes) noexcept {
  constexpr float kUnit = 1e-3f;  // how far a unit vector's square may be from 1
  const float squared =
      hit.normal[0] * hit.normal[0] + hit.normal[1] * hit.normal[1] + hit.normal[2] * hit.normal[2];
  float moved = 0;  // of zeros, or NaN
  for (const float v : hit.velocity_m_s) moved += v * 0;
  return hit.probe < probes && std::fabs(squared - 1) <= kUnit && moved == 0 && std::isfinite(hit.gap_m) &&
         hit.along >= -1 && hit.along <= 1 && hit.friction >= 0 && std::isfinite(hit.friction) &&
         hit.restitution >= 0 && hit.restitution <= 1;
}

}  // namespace sinew::core
