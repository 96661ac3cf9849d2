// shapes.hpp  Simple meshes for pictures.
#pragma once
#include <cmath>
#include <numbers>

#include "baker/render/mesh.hpp"

namespace sinew::test {

inline render::Mesh sphere(const Eigen::Vector3f& center, float radius, const render::Rgb& color,
                           uint32_t rings = 64) {
  render::Mesh mesh;
  const uint32_t sides = 2 * rings;
  for (uint32_t i = 0; i <= rings; ++i) {
    const float polar = std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rings);
    for (uint32_t j = 0; j < sides; ++j) {
      const float around = 2 * std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(sides);
      const Eigen::Vector3f n(std::sin(polar) * std::cos(around), std::cos(polar),
                              std::sin(polar) * std::sin(around));
      mesh.positions.push_back(center + radius * n);
      mesh.normals.push_back(n);
      mesh.colors.push_back(color);
    }
  }
  for (uint32_t i = 0; i < rings; ++i) {
    for (uint32_t j = 0; j < sides; ++j) {
      const uint32_t a = i * sides + j, b = i * sides + (j + 1) % sides;
      mesh.triangles.push_back({a, b, a + sides});
      mesh.triangles.push_back({b, b + sides, a + sides});
    }
  }
  return mesh;
}

}  // namespace sinew::test
