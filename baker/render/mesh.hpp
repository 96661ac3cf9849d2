// mesh.hpp  What is drawn: triangles with smooth normals and vertex colours.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "baker/render/picture/color.hpp"

namespace sinew::render {

struct Mesh {
  std::vector<Eigen::Vector3f> positions;  // metres, Y up
  std::vector<Eigen::Vector3f> normals;    // unit, one a vertex
  std::vector<Rgb> colors;                 // one a vertex
  std::vector<std::array<uint32_t, 3>> triangles;
};

// Area-weighted. welded[v] is the first vertex at v's place, so that a seam does not show; empty: every
// vertex alone.
std::vector<Eigen::Vector3f> smooth_normals(std::span<const Eigen::Vector3f> positions,
                                            std::span<const std::array<uint32_t, 3>> triangles,
                                            std::span<const uint32_t> welded = {});

Eigen::AlignedBox3f bounding_box(std::span<const Eigen::Vector3f> positions);

}  // namespace sinew::render
