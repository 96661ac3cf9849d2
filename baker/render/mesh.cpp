// mesh.cpp  see mesh.hpp.
#include "baker/render/mesh.hpp"

namespace sinew::render {

std::vector<Eigen::Vector3f> smooth_normals(std::span<const Eigen::Vector3f> positions,
                                            std::span<const std::array<uint32_t, 3>> triangles,
                                            std::span<const uint32_t> welded) {
  const auto home = [&](uint32_t v) { return welded.empty() ? v : welded[v]; };
  std::vector<Eigen::Vector3f> normals(positions.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3f twice_area = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
    for (const uint32_t v : {a, b, c}) normals[home(v)] += twice_area;
  }
  for (uint32_t v = 0; v < normals.size(); ++v) {
    if (home(v) != v) continue;
    const float length = normals[v].norm();
    normals[v] = length > 0 ? Eigen::Vector3f(normals[v] / length) : Eigen::Vector3f::UnitY();
  }
  for (uint32_t v = 0; v < normals.size(); ++v) normals[v] = normals[home(v)];
  return normals;
}

Eigen::AlignedBox3f bounding_box(std::span<const Eigen::Vector3f> positions) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : positions) box.extend(position);
  return box;
}

}  // namespace sinew::render
