// sampling.hpp  Fixed sample patterns: the same picture on every run, and noise that the eye forgives.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "baker/render/blue_noise.hpp"

namespace sinew::render {

// A point of the (0,2)-sequence: any 2^k in a row fall into distinct cells of every 2^a x 2^(k-a) grid.
// Kollig and Keller, Efficient multidimensional sampling, 2002.
inline Eigen::Vector2f stratified_point(uint32_t index) {
  uint32_t x = 0, y = 0;
  uint32_t column = 1u << 31;
  for (uint32_t bit = 0, i = index; i != 0; ++bit, i >>= 1, column ^= column >> 1) {
    if (i & 1) {
      x |= 1u << (31 - bit);
      y ^= column;
    }
  }
  constexpr float kUnit = 1.0f / 16777216;
  return {static_cast<float>(x >> 8) * kUnit, static_cast<float>(y >> 8) * kUnit};
}

// One two-dimensional stream of samples for a pixel; streams of different numbers are independent.
class PixelSamples {
 public:
  PixelSamples(int x, int y, uint32_t stream) : order_(stream * 5) {
    const auto px = static_cast<uint32_t>(x), py = static_cast<uint32_t>(y);
    offset_ = {blue_noise(px + 19 * stream, py + 43 * stream),
               blue_noise(px + 29 + 37 * stream, py + 11 + 23 * stream)};
  }
  // Different streams pair their points differently: an odd xor permutes any aligned run of 2^k.
  Eigen::Vector2f operator()(uint32_t sample) const {
    const Eigen::Vector2f p = stratified_point(sample ^ order_) + offset_;
    return {p.x() - std::floor(p.x()), p.y() - std::floor(p.y())};
  }

 private:
  Eigen::Vector2f offset_;
  uint32_t order_ = 0;
};

// Two unit vectors that complete the unit vector n to an orthonormal basis (Duff et al. 2017).
struct Basis {
  Eigen::Vector3f tangent, bitangent;
  explicit Basis(const Eigen::Vector3f& n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
    tangent = {1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
    bitangent = {b, sign + n.y() * n.y() * a, -n.y()};
  }
};

inline Eigen::Vector2f disk_point(const Eigen::Vector2f& sample) {
  const float radius = std::sqrt(sample.x()), angle = 6.2831853f * sample.y();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// Density cosine / pi around n.
inline Eigen::Vector3f cosine_direction(const Eigen::Vector3f& n, const Eigen::Vector2f& sample) {
  const Eigen::Vector2f d = disk_point(sample);
  const Basis basis(n);
  return d.x() * basis.tangent + d.y() * basis.bitangent + std::sqrt(std::max(0.0f, 1 - sample.x())) * n;
}

}  // namespace sinew::render
