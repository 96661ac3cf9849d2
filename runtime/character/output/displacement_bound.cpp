// displacement_bound.cpp  see displacement_bound.hpp.
#include "character/output/displacement_bound.hpp"

#include <cmath>

#include "tissue/modes/guard.hpp"

namespace sinew::world {

float displacement_bound_m(const Asset& asset, size_t region) noexcept {
  return kMostShown * asset.extent_m / static_cast<float>(asset.soft.most_shared[region]);
}

Eigen::Vector3f within_bound(const Eigen::Vector3f& displacement_m, float bound_m) noexcept {
  // Eigen's stableNorm divides by the largest, and its inverse may be flushed to zero.
  const float length_m = std::hypot(displacement_m.x(), displacement_m.y(), displacement_m.z());
  if (!(length_m < HUGE_VALF)) return Eigen::Vector3f::Zero();
  return tissue::limit_share(length_m, bound_m) * displacement_m;
}

void hold_within_bound(float bound_m, size_t padded, float* carried) noexcept {
  float *x = carried, *y = carried + padded, *z = carried + 2 * padded;
  const float free_m = tissue::kFreeShare * bound_m, free_m2 = free_m * free_m;
  uint32_t beyond = 0;
  for (size_t v = 0; v < padded; ++v) beyond += !(x[v] * x[v] + y[v] * y[v] + z[v] * z[v] <= free_m2);
  if (beyond == 0) return;
  for (size_t v = 0; v < padded; ++v) {
    const Eigen::Vector3f held = within_bound({x[v], y[v], z[v]}, bound_m);
    x[v] = held.x(), y[v] = held.y(), z[v] = held.z();
  }
}

}  // namespace sinew::world
