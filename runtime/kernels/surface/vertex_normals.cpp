// vertex_normals.cpp  Area vectors gathered at the first vertex of each place and side.
#include "kernels/surface/vertex_normals.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace sinew::simd {
namespace {

struct Vector {
  float x, y, z;
};

Vector vector(const float* v) noexcept { return {v[0], v[1], v[2]}; }
Vector operator+(Vector a, Vector b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(Vector a, Vector b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(float s, Vector a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
float dot(Vector a, Vector b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(Vector a, Vector b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

bool has_length(float length2) noexcept { return length2 > 0 && std::isfinite(length2); }

struct Rows {
  Vector row[3];
};

// A vertex's skin matrix without its translation, a row of four floats at a time.
Rows blended(const uint16_t* joints, const float* weights, const float* matrices) noexcept {
  using Row = Eigen::Map<const Eigen::Array4f>;
  Eigen::Array4f sum[3] = {Eigen::Array4f::Zero(), Eigen::Array4f::Zero(), Eigen::Array4f::Zero()};
  for (size_t k = 0; k < kSkinInfluences && weights[k] > 0; ++k) {
    const float* joint = matrices + size_t{12} * joints[k];
    for (int r = 0; r < 3; ++r) sum[r] += weights[k] * Row(joint + 4 * r);
  }
  return {{vector(sum[0].data()), vector(sum[1].data()), vector(sum[2].data())}};
}

// The least rotation that brings a to b, of any lengths, applied to v.
Vector turned(Vector v, Vector a, Vector b) noexcept {
  constexpr float kOpposite = 1e-4f;
  const float length2 = dot(a, a) * dot(b, b);
  if (!has_length(length2)) return v;
  const float scale = 1 / std::sqrt(length2), c = scale * dot(a, b);
  if (1 + c < kOpposite) return -1 * v;  // about which axis is not known
  const Vector axis = scale * cross(a, b);
  return c * v + cross(axis, v) + (dot(axis, v) / (1 + c)) * axis;
}

Vector turned_normal(const Rows& m, Vector bound, Vector bind_face, Vector face) noexcept {
  // Of the row-major matrix; they are det M M^-T, so that what faces outwards turns round in a mirror.
  const Vector cofactors[3] = {cross(m.row[1], m.row[2]), cross(m.row[2], m.row[0]),
                               cross(m.row[0], m.row[1])};
  const auto skinned = [&](Vector v) {
    return Vector{dot(cofactors[0], v), dot(cofactors[1], v), dot(cofactors[2], v)};
  };
  const Vector normal = turned(skinned(bound), skinned(bind_face), face);
  const float length2 = dot(normal, normal), outwards = dot(m.row[0], cofactors[0]) < 0 ? -1.0f : 1.0f;
  return has_length(length2) ? (outwards / std::sqrt(length2)) * normal : bound;
}

}  // namespace

void sum_areas(const AreaJob& job) noexcept {
  std::fill_n(job.out, 3 * job.welded.size(), 0.0f);
  for (size_t t = 0; t + 2 < job.triangles.size(); t += 3) {
    const uint32_t* corners = &job.triangles[t];
    const Vector a = vector(job.positions + size_t{3} * corners[0]);
    const Vector n = cross(vector(job.positions + size_t{3} * corners[1]) - a,
                           vector(job.positions + size_t{3} * corners[2]) - a);
    for (int k = 0; k < 3; ++k) {
      float* sum = job.out + size_t{3} * job.welded[corners[k]];
      sum[0] += n.x, sum[1] += n.y, sum[2] += n.z;
    }
  }
}

void turn_normals(const NormalsJob& job) noexcept {
  const auto* joints = reinterpret_cast<const char*>(job.joints);
  const auto* weights = reinterpret_cast<const char*>(job.weights);
  for (size_t v = 0; v < job.count; ++v) {
    const Rows skin = blended(reinterpret_cast<const uint16_t*>(joints + v * job.skin_stride),
                              reinterpret_cast<const float*>(weights + v * job.skin_stride), job.matrices);
    const Vector normal = turned_normal(skin, vector(job.normals + 3 * v), vector(job.bind_faces + 3 * v),
                                        vector(job.areas + size_t{3} * job.welded[v]));
    job.out[3 * v] = normal.x, job.out[3 * v + 1] = normal.y, job.out[3 * v + 2] = normal.z;
  }
}

}  // namespace sinew::simd
