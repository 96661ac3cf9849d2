// vertex_normals.hpp  Smooth normals of a moved surface.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace sinew::simd {

struct NormalsJob {
  const float* positions;               // x y z at each stride
  size_t position_stride;               // bytes
  std::span<const uint32_t> triangles;  // 3 a triangle
  std::span<const uint32_t> welded;  // [vertices]: first vertex at the same place, so that seams do not show
  float* out;                        // x y z at each stride; unit, or zero where no triangle has area
  size_t out_stride;                 // bytes
};

// Area-weighted mean of the triangles around a place. O(triangles + vertices), allocates nothing; out must
// not overlap positions.
void vertex_normals(const NormalsJob& job) noexcept;

}  // namespace sinew::simd
