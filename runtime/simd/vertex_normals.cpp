// vertex_normals.cpp  Gathers at the first vertex of each place, then copies to its twins.
#include "simd/vertex_normals.hpp"

#include <cmath>

namespace sinew::simd {
namespace {

const float* position_at(const NormalsJob& job, size_t vertex) {
  return reinterpret_cast<const float*>(reinterpret_cast<const char*>(job.positions) +
                                        vertex * job.position_stride);
}

float* normal_at(const NormalsJob& job, size_t vertex) {
  return reinterpret_cast<float*>(reinterpret_cast<char*>(job.out) + vertex * job.out_stride);
}

// Twice the area long.
void add_triangle(const NormalsJob& job, const uint32_t* corners) {
  const float* a = position_at(job, corners[0]);
  const float* b = position_at(job, corners[1]);
  const float* c = position_at(job, corners[2]);
  const float e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const float f[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const float n[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
  for (int k = 0; k < 3; ++k) {
    float* sum = normal_at(job, job.welded[corners[k]]);
    for (int axis = 0; axis < 3; ++axis) sum[axis] += n[axis];
  }
}

void normalize(float* n) {
  const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const float scale = length > 0 ? 1 / length : 0;
  for (int axis = 0; axis < 3; ++axis) n[axis] *= scale;
}

}  // namespace

void vertex_normals(const NormalsJob& job) noexcept {
  const size_t vertices = job.welded.size();
  for (size_t v = 0; v < vertices; ++v) {
    for (int axis = 0; axis < 3; ++axis) normal_at(job, v)[axis] = 0;
  }
  for (size_t t = 0; t + 2 < job.triangles.size(); t += 3) add_triangle(job, &job.triangles[t]);
  for (size_t v = 0; v < vertices; ++v) {
    if (job.welded[v] == v) normalize(normal_at(job, v));
  }
  for (size_t v = 0; v < vertices; ++v) {
    const float* first = normal_at(job, job.welded[v]);
    for (int axis = 0; axis < 3; ++axis) normal_at(job, v)[axis] = first[axis];
  }
}

}  // namespace sinew::simd
