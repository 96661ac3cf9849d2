// hair.hpp  Strands of one kind that differ as hairs do: no two lanes of a batch do the same.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "rods/strand.hpp"

namespace sinew::test {

// A number in [-1, 1) of two counters, the same everywhere.
inline double scattered(uint32_t n, uint32_t salt) {
  uint32_t x = (n + 1) * 2654435761u ^ (salt + 1) * 2246822519u;
  x = (x ^ (x >> 15)) * 2246822519u;
  x = (x ^ (x >> 13)) * 3266489917u;
  return static_cast<double>(x ^ (x >> 16)) / 2147483648.0 - 1;
}

// About the origin, where its root begins.
inline void turn_strand(std::vector<rods::SegmentDef>* segments, const Eigen::Quaterniond& by) {
  for (rods::SegmentDef& s : *segments) {
    const Eigen::Vector3d place = by * Eigen::Vector3d(s.position_m);
    const float* q = s.orientation;
    const Eigen::Vector4d turn =
        (by * Eigen::Quaternionf(q[3], q[0], q[1], q[2]).cast<double>()).normalized().coeffs();
    for (int k = 0; k < 3; ++k) s.position_m[k] = place[k];
    for (int k = 0; k < 4; ++k) s.orientation[k] = static_cast<float>(turn[k]);
  }
}

// `count` copies: lengths, radii and moduli within five per cent, turned about the vertical by anything and
// off the horizontal by up to 0.4 rad.
inline std::vector<std::vector<rods::SegmentDef>> varied(const std::vector<rods::SegmentDef>& one,
                                                         uint32_t count) {
  std::vector<std::vector<rods::SegmentDef>> out(count, one);
  for (uint32_t n = 0; n < count; ++n) {
    const double longer = 1 + 0.05 * scattered(n, 0);
    for (rods::SegmentDef& s : out[n]) {
      s.length_m *= static_cast<float>(longer);
      for (double& x : s.position_m) x *= longer;
      s.radius_m *= static_cast<float>(1 + 0.05 * scattered(n, 1));
      s.young_modulus_pa *= static_cast<float>(1 + 0.05 * scattered(n, 2));
      s.torsion_modulus_pa *= static_cast<float>(1 + 0.05 * scattered(n, 3));
    }
    turn_strand(&out[n], Eigen::AngleAxisd(M_PI * scattered(n, 4), Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(0.4 * scattered(n, 5), Eigen::Vector3d::UnitZ()));
  }
  return out;
}

}  // namespace sinew::test
