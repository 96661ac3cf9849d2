// read.cpp  The published surface written into the caller's memory.
#include "world/read.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/status.hpp"
#include "simd/kernels.hpp"
#include "simd/vertex_normals.hpp"
#include "world/pose.hpp"
#include "world/publish.hpp"
#include "world/rod_publish.hpp"

namespace sinew::world {
namespace {

using core::make_status;
using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr uint32_t kChunk =
    256;  // vertices worked on at a time, on the stack: 3 KB, well inside the first cache

struct Chunk {
  uint32_t first, count;
  float points[kChunk][3];
};

// Written once and never read: engines map memory that reads slowly, or not at all.
void store(const ReadDef& def, size_t vertex, const Vector3f& value) noexcept {
  std::memcpy(reinterpret_cast<std::byte*>(def.out) + vertex * def.stride_bytes, value.data(),
              3 * sizeof(float));
}

void bind_chunk(const Instance& instance, Chunk& chunk) noexcept {
  const float* positions = instance.level->pack.positions.data() + size_t{3} * chunk.first;
  std::memcpy(chunk.points, positions, sizeof(float) * 3 * chunk.count);
}

// The present pose's matrices, made where they are read.
class SkinMatrices {
 public:
  explicit SkinMatrices(const Instance& instance) noexcept : data_(instance.skin) {
    if (!skins_on_reading(instance)) return;
    skin_matrices(instance.level->pack.joints, shown_joints(instance), here_);
    data_ = here_;
  }
  SkinMatrices(const SkinMatrices&) = delete;
  SkinMatrices& operator=(const SkinMatrices&) = delete;
  const float* data() const noexcept { return data_; }

 private:
  float here_[12 * kJointsOnStack];
  const float* data_;
};

void skin_chunk(const Instance& instance, const SkinMatrices& matrices, Chunk& chunk) noexcept {
  const pack::PackView& pack = instance.level->pack;
  simd::kernels().skin({.points = chunk.points[0],
                        .point_stride = 3 * sizeof(float),
                        .joints = pack.skin[chunk.first].joint,
                        .weights = pack.skin[chunk.first].weight,
                        .skin_stride = sizeof(pack::SkinRecord),
                        .matrices = matrices.data(),
                        .out = chunk.points[0],
                        .out_stride = 3 * sizeof(float),
                        .count = chunk.count});
}

// Adds what the regions carry to the chunk's vertices, in bind-pose axes.
void add_carried(const Instance& instance, Chunk& chunk) noexcept {
  if (!instance.displaced) return;
  const pack::PackView& pack = instance.level->pack;
  const float* carried = instance.carried;
  for (const pack::RegionRecord& region : pack.regions) {
    const uint32_t* begin = pack.region_vertices.data() + region.first_vertex;
    const uint32_t* end = begin + region.vertex_count;
    const size_t padded = region.padded_vertices;
    const uint32_t* vertex = std::lower_bound(begin, end, chunk.first);
    for (; vertex != end && *vertex < chunk.first + chunk.count; ++vertex) {
      const float* delta = carried + (vertex - begin);
      float* point = chunk.points[*vertex - chunk.first];
      for (size_t k = 0; k < 3; ++k) point[k] += instance.carried_share * delta[k * padded];
    }
    carried += 3 * padded;
  }
}

template <class Work>
void for_each_chunk(const Instance& instance, Work work) noexcept {
  Chunk chunk;
  const uint32_t vertices = instance.asset->vertex_count();
  for (chunk.first = 0; chunk.first < vertices; chunk.first += chunk.count) {
    chunk.count = std::min(kChunk, vertices - chunk.first);
    work(chunk);
  }
}

struct Placement {
  Matrix3f rotation = Matrix3f::Identity();
  Vector3f offset = Vector3f::Zero();
  float scale = 1;
};

Placement placement_of(const Instance& instance, const ReadDef& def) noexcept {
  Placement placement;
  if (def.space != Space::kWorld) return placement;
  const RootTransform& root = instance.state->root;
  placement.rotation = Eigen::Map<const Eigen::Quaternionf>(root.rotation_xyzw).toRotationMatrix();
  placement.scale = static_cast<float>(root.scale);
  for (int k = 0; k < 3; ++k) {
    placement.offset[k] = static_cast<float>(root.scale * root.position_m[k] - def.origin_m[k]);
  }
  return placement;
}

void write_places(const Instance& instance, const ReadDef& def) noexcept {
  const Placement to = placement_of(instance, def);
  const SkinMatrices matrices(instance);
  for_each_chunk(instance, [&](Chunk& chunk) {
    bind_chunk(instance, chunk);
    add_carried(instance, chunk);
    skin_chunk(instance, matrices, chunk);
    for (uint32_t i = 0; i < chunk.count; ++i) {
      const Vector3f point(chunk.points[i]);
      store(def, chunk.first + i,
            def.space == Space::kWorld ? to.scale * (to.rotation * point) + to.offset : point);
    }
  });
}

void write_bind_deltas(const Instance& instance, const ReadDef& def) noexcept {
  for_each_chunk(instance, [&](Chunk& chunk) {
    std::memset(chunk.points, 0, sizeof chunk.points);
    add_carried(instance, chunk);
    for (uint32_t i = 0; i < chunk.count; ++i) store(def, chunk.first + i, Vector3f(chunk.points[i]));
  });
}

}  // namespace

Status check_read(const ReadDef& def, uint32_t vertex_count, bool normals) noexcept {
  constexpr size_t kSmallestStride = 3 * sizeof(float);
  constexpr StatusCode kInvalid = StatusCode::kInvalidArgument;
  if (static_cast<uint32_t>(def.space) > static_cast<uint32_t>(Space::kBind)) {
    return make_status(kInvalid, "read: space %u does not exist", static_cast<uint32_t>(def.space));
  }
  if (normals && def.space == Space::kBind)
    return make_status(kInvalid, "read_normals: space must be kCharacter or kWorld");
  if (!def.out) return make_status(kInvalid, "read: out is a null pointer");
  if (reinterpret_cast<uintptr_t>(def.out) % sizeof(float) != 0)
    return make_status(kInvalid, "read: out is not aligned to 4 bytes");
  if (def.stride_bytes < kSmallestStride || def.stride_bytes % sizeof(float) != 0) {
    return make_status(kInvalid, "read: stride_bytes is %zu; it must be a multiple of 4, at least 12",
                       def.stride_bytes);
  }
  if (def.capacity < vertex_count) {
    return make_status(kInvalid, "read: capacity is %zu, the asset has %u vertices", def.capacity,
                       vertex_count);
  }
  for (double origin : def.origin_m) {
    if (!std::isfinite(origin))
      return make_status(StatusCode::kNotFinite, "read: origin_m holds NaN or infinity");
  }
  return {};
}

void read_positions(const Instance& instance, const ReadDef& def) noexcept {
  if (def.space == Space::kBind)
    write_bind_deltas(instance, def);
  else
    write_places(instance, def);
}

void read_normals(const Instance& instance, const ReadDef& def) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const uint32_t vertices = instance.asset->vertex_count();
  write_places(instance, {.out = instance.surface, .capacity = vertices});
  simd::sum_areas({.positions = instance.surface,
                   .triangles = pack.triangles,
                   .welded = pack.welded,
                   .out = instance.areas});
  const Matrix3f rotation = placement_of(instance, def).rotation;
  const SkinMatrices matrices(instance);
  for_each_chunk(instance, [&](Chunk& chunk) {
    const size_t first = chunk.first;
    simd::turn_normals({.normals = &pack.normals[3 * first],
                        .bind_faces = &pack.face_normals[3 * first],
                        .welded = &pack.welded[first],
                        .areas = instance.areas,
                        .joints = pack.skin[first].joint,
                        .weights = pack.skin[first].weight,
                        .skin_stride = sizeof(pack::SkinRecord),
                        .matrices = matrices.data(),
                        .count = chunk.count,
                        .out = chunk.points[0]});
    for (uint32_t i = 0; i < chunk.count; ++i) {
      const Vector3f normal(chunk.points[i]);
      store(def, first + i, def.space == Space::kWorld ? rotation * normal : normal);
    }
  });
}

}  // namespace sinew::world
