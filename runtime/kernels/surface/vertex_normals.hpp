// vertex_normals.hpp  Normals of a moved surface: the file's own, turned as skinning and the surface turn.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace sinew::simd {

struct AreaJob {
  const float* positions;               // x y z a vertex
  std::span<const uint32_t> triangles;  // 3 a triangle
  std::span<const uint32_t> welded;     // [vertices]: the first vertex at the same place that faces alike
  float* out;  // x y z a vertex: of the first ones the sum of their triangles' area vectors; others are zero
};

// O(triangles + vertices), allocates nothing; out must not overlap positions.
void sum_areas(const AreaJob& job) noexcept;

inline constexpr size_t kSkinInfluences = 8;

// Vertices in a row; every pointer is the first one's, but areas and matrices, which are all.
struct NormalsJob {
  const float* normals;     // x y z, of the bind pose, unit: the file's
  const float* bind_faces;  // x y z, of the triangles around it in the bind pose; zero: it has none
  const uint32_t* welded;   // as of AreaJob
  const float* areas;       // what sum_areas gave
  const uint16_t* joints;   // kSkinInfluences of each vertex
  const float* weights;     // the same, descending
  size_t skin_stride;       // bytes from a vertex's joints, and weights, to the next one's
  const float* matrices;    // 12 a joint: skin matrices, row-major 3x4
  size_t count;
  float* out;  // x y z
};

// A vertex's skin matrix turns its normal and its bind_face (by its cofactors, so that scale and shear keep
// them square to the surface), and what is left between bind_face so turned and the area now turns the normal
// further: a hard edge stays hard and a smooth one smooth. Mirrored, it points outwards still. Unit, whatever
// it is given: where no triangle has area it goes with the skin matrix alone, and where that flattens space
// it stays as bound. O(count).
void turn_normals(const NormalsJob& job) noexcept;

}  // namespace sinew::simd
