// read.cpp  The published surface written into the caller's memory.
#include "character/output/read.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "character/motion/placement.hpp"
#include "character/output/shown_skin.hpp"
#include "core/status.hpp"
#include "kernels/kernels.hpp"
#include "kernels/surface/vertex_normals.hpp"

namespace sinew::world {
namespace {

using core::make_status;
using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr uint32_t kChunk =
    256;  // vertices worked on at a time, on the stack: 3 KB, well inside the first cache

// Vertices that are written one after the other, from `slot` on: those from `first` on, or those listed.
struct Chunk {
  uint32_t first, count, slot;
  const uint32_t* listed;  // [count]; null: one after the other
  float points[kChunk][3];

  size_t vertex(uint32_t i) const noexcept { return listed ? listed[i] : first + i; }
};

size_t bytes_of(VertexFormat format) noexcept {
  return format == VertexFormat::kFloat3   ? 3 * sizeof(float)
         : format == VertexFormat::kFloat4 ? 4 * sizeof(float)
                                           : 4 * sizeof(uint16_t);
}

size_t alignment_of(VertexFormat format) noexcept {
  return format == VertexFormat::kHalf4 ? sizeof(uint16_t) : sizeof(float);
}

// Written once and never read: engines map memory that reads slowly, or not at all.
class Writer {
 public:
  explicit Writer(const VertexStream& stream) noexcept
      : out_(static_cast<std::byte*>(stream.out)),
        stride_(stream.stride_bytes ? stream.stride_bytes : bytes_of(stream.format)),
        format_(stream.format) {}
  explicit operator bool() const noexcept { return out_ != nullptr; }

  void put(size_t slot, const Vector3f& value, float fourth) const noexcept {
    std::byte* to = out_ + slot * stride_;
    if (format_ == VertexFormat::kHalf4) return put_halves(to, value, fourth);
    std::memcpy(to, value.data(), 3 * sizeof(float));
    if (format_ == VertexFormat::kFloat4) std::memcpy(to + 3 * sizeof(float), &fourth, sizeof fourth);
  }

 private:
  static void put_halves(std::byte* to, const Vector3f& value, float fourth) noexcept {
    const uint16_t halves[4] = {half(value.x()), half(value.y()), half(value.z()), half(fourth)};
    std::memcpy(to, halves, sizeof halves);
  }
  static uint16_t half(float value) noexcept {
    return std::bit_cast<uint16_t>(Eigen::half_impl::float_to_half_rtne(value).x);
  }

  std::byte* out_;
  size_t stride_;
  VertexFormat format_;
};

void bind_chunk(const Instance& instance, Chunk& chunk) noexcept {
  const float* positions = instance.level->pack.positions.data();
  if (!chunk.listed) {
    std::memcpy(chunk.points, positions + size_t{3} * chunk.first, sizeof(float) * 3 * chunk.count);
    return;
  }
  for (uint32_t i = 0; i < chunk.count; ++i) std::copy_n(positions + 3 * chunk.vertex(i), 3, chunk.points[i]);
}

// The records of what is listed, side by side.
struct ListedSkin {
  pack::SkinRecord records[kChunk];  // 12 KB
};

const pack::SkinRecord* records_of(const pack::SkinRecord* all, const Chunk& chunk,
                                   ListedSkin& listed) noexcept {
  if (!chunk.listed) return all + chunk.first;
  for (uint32_t i = 0; i < chunk.count; ++i) listed.records[i] = all[chunk.listed[i]];
  return listed.records;
}

void skin_chunk(const Instance& instance, const ShownSkin& skin, Chunk& chunk) noexcept {
  ListedSkin listed;
  const pack::SkinRecord* records = records_of(instance.level->pack.skin.data(), chunk, listed);
  simd::kernels().skin({.points = chunk.points[0],
                        .point_stride = 3 * sizeof(float),
                        .joints = records->joint,
                        .weights = records->weight,
                        .skin_stride = sizeof(pack::SkinRecord),
                        .matrices = skin.matrices(),
                        .out = chunk.points[0],
                        .out_stride = 3 * sizeof(float),
                        .count = chunk.count});
}

void add_carried_in_a_row(const Instance& instance, Chunk& chunk) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const float* carried = instance.published.carried;
  for (const pack::RegionRecord& region : pack.regions) {
    const uint32_t* begin = pack.region_vertices.data() + region.first_vertex;
    const uint32_t* end = begin + region.vertex_count;
    const size_t padded = region.padded_vertices;
    const uint32_t* vertex = std::lower_bound(begin, end, chunk.first);
    for (; vertex != end && *vertex < chunk.first + chunk.count; ++vertex) {
      const float* delta = carried + (vertex - begin);
      float* point = chunk.points[*vertex - chunk.first];
      for (size_t k = 0; k < 3; ++k) point[k] += instance.published.carried_share * delta[k * padded];
    }
    carried += 3 * padded;
  }
}

// Adds what the regions carry to the chunk's vertices, in bind-pose axes.
void add_carried(const Instance& instance, Chunk& chunk) noexcept {
  if (!instance.marks.displaced) return;
  if (!chunk.listed) return add_carried_in_a_row(instance, chunk);
  for (uint32_t i = 0; i < chunk.count; ++i)
    for (const SoftVertices::Place& place : instance.asset->soft.places_of(chunk.slot + i))
      for (size_t k = 0; k < 3; ++k)
        chunk.points[i][k] +=
            instance.published.carried_share * instance.published.carried[place.first + k * place.pitch];
}

template <class Work>
void for_each_chunk(const Instance& instance, Work work) noexcept {
  Chunk chunk;
  chunk.listed = nullptr;
  const uint32_t vertices = instance.asset->vertex_count();
  for (chunk.first = 0; chunk.first < vertices; chunk.first += chunk.count) {
    chunk.count = std::min(kChunk, vertices - chunk.first);
    chunk.slot = chunk.first;
    work(chunk);
  }
}

template <class Work>
void for_each_soft_chunk(const Instance& instance, Work work) noexcept {
  Chunk chunk;
  chunk.first = 0;
  const std::span<const uint32_t> soft = instance.asset->soft.all();
  for (chunk.slot = 0; chunk.slot < soft.size(); chunk.slot += chunk.count) {
    chunk.listed = soft.data() + chunk.slot;
    chunk.count = std::min(kChunk, static_cast<uint32_t>(soft.size()) - chunk.slot);
    work(chunk);
  }
}

template <class Work>
void for_each_wanted(const Instance& instance, const SurfaceReadDef& def, Work work) noexcept {
  if (def.moved_only)
    for_each_soft_chunk(instance, work);
  else
    for_each_chunk(instance, work);
}

void write_places(const Instance& instance, const SurfaceReadDef& def) noexcept {
  const Placement to = placement_of(instance, def.space, def.origin_m);
  const ShownSkin skin(instance);
  const Writer positions(def.positions);
  for_each_wanted(instance, def, [&](Chunk& chunk) {
    bind_chunk(instance, chunk);
    add_carried(instance, chunk);
    skin_chunk(instance, skin, chunk);
    for (uint32_t i = 0; i < chunk.count; ++i)
      positions.put(chunk.slot + i, to.place(Vector3f(chunk.points[i])), 1);
  });
}

void write_bind_deltas(const Instance& instance, const SurfaceReadDef& def) noexcept {
  const Writer positions(def.positions);
  for_each_wanted(instance, def, [&](Chunk& chunk) {
    std::memset(chunk.points, 0, sizeof(float) * 3 * chunk.count);
    add_carried(instance, chunk);
    for (uint32_t i = 0; i < chunk.count; ++i) positions.put(chunk.slot + i, Vector3f(chunk.points[i]), 0);
  });
}

// ---- with normals and tangents ----

// How the vertices of the surface that is read are skinned: as the pose has them, or, in bind space, not.
struct SurfaceSkin {
  const float* matrices;
  const pack::SkinRecord* records;
  size_t stride;  // 0: all vertices alike
};

constexpr pack::SkinRecord kUnskinned{.joint = {}, .weight = {1}};
constexpr float kIdentity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

SurfaceSkin surface_skin(const Instance& instance, const SurfaceReadDef& def,
                         const ShownSkin& skin) noexcept {
  if (def.space == Space::kBind) return {kIdentity, &kUnskinned, 0};
  return {skin.matrices(), instance.level->pack.skin.data(), sizeof(pack::SkinRecord)};
}

// All of it, in the character's space, or in the bind pose; and its triangles' areas.
void make_surface(const Instance& instance, const SurfaceReadDef& def, const ShownSkin& skin) noexcept {
  for_each_chunk(instance, [&](Chunk& chunk) {
    bind_chunk(instance, chunk);
    add_carried(instance, chunk);
    if (def.space != Space::kBind) skin_chunk(instance, skin, chunk);
    std::memcpy(instance.published.surface + size_t{3} * chunk.first, chunk.points,
                sizeof(float) * 3 * chunk.count);
  });
  const pack::PackView& pack = instance.level->pack;
  simd::sum_areas({.positions = instance.published.surface,
                   .triangles = pack.triangles,
                   .welded = pack.welded,
                   .out = instance.published.areas});
}

// Into the chunk's points; of those that are listed one by one.
void find_normals(const Instance& instance, const SurfaceSkin& skin, Chunk& chunk) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const uint32_t in_a_row = chunk.listed ? 1 : chunk.count;
  for (uint32_t i = 0; i < chunk.count; i += in_a_row) {
    const size_t first = chunk.vertex(i);
    const pack::SkinRecord& record = skin.records[skin.stride ? first : 0];
    simd::turn_normals({.normals = &pack.normals[3 * first],
                        .bind_faces = &pack.face_normals[3 * first],
                        .welded = &pack.welded[first],
                        .areas = instance.published.areas,
                        .joints = record.joint,
                        .weights = record.weight,
                        .skin_stride = skin.stride,
                        .matrices = skin.matrices,
                        .count = in_a_row,
                        .out = chunk.points[i]});
  }
}

void put_surface(const Instance& instance, const SurfaceReadDef& def, const Placement& to, const Chunk& chunk,
                 const Writer& positions) noexcept {
  for (uint32_t i = 0; i < chunk.count; ++i) {
    const size_t vertex = chunk.vertex(i);
    const Vector3f point(instance.published.surface + 3 * vertex);
    if (def.space == Space::kBind)
      positions.put(chunk.slot + i, point - Vector3f(&instance.level->pack.positions[3 * vertex]), 0);
    else
      positions.put(chunk.slot + i, to.place(point), 1);
  }
}

// The bind pose's, as skinning turns it, brought square to the normal.
Vector3f tangent_beside(const Matrix3f& skin, const Vector3f& bound, const Vector3f& normal) noexcept {
  const Vector3f skinned = skin * bound, flat = skinned - normal.dot(skinned) * normal;
  const float length2 = flat.squaredNorm();
  return length2 > 0 && std::isfinite(length2) ? Vector3f(flat / std::sqrt(length2))
                                               : normal.unitOrthogonal();
}

void put_tangents(const Instance& instance, const SurfaceSkin& skin, const Placement& to, const Chunk& chunk,
                  const Writer& tangents) noexcept {
  for (uint32_t i = 0; i < chunk.count; ++i) {
    const size_t vertex = chunk.vertex(i);
    const float* bound = &instance.level->pack.tangents[4 * vertex];
    const Matrix3f turn = blended(skin.records[skin.stride ? vertex : 0], skin.matrices).leftCols<3>();
    const float hand = turn.determinant() < 0 ? -bound[3] : bound[3];
    tangents.put(chunk.slot + i, to.turn(tangent_beside(turn, Vector3f(bound), Vector3f(chunk.points[i]))),
                 hand);
  }
}

void write_surface(const Instance& instance, const SurfaceReadDef& def) noexcept {
  const ShownSkin shown(instance);
  make_surface(instance, def, shown);
  const Placement to = placement_of(instance, def.space, def.origin_m);
  const SurfaceSkin skin = surface_skin(instance, def, shown);
  const Writer positions(def.positions), normals(def.normals), tangents(def.tangents);
  for_each_wanted(instance, def, [&](Chunk& chunk) {
    if (positions) put_surface(instance, def, to, chunk, positions);
    find_normals(instance, skin, chunk);
    for (uint32_t i = 0; normals && i < chunk.count; ++i)
      normals.put(chunk.slot + i, to.turn(Vector3f(chunk.points[i])), 0);
    if (tangents) put_tangents(instance, skin, to, chunk, tangents);
  });
}

Status check_stream(const VertexStream& stream, const char* name) noexcept {
  constexpr StatusCode kInvalid = StatusCode::kInvalidArgument;
  if (!stream.out) return {};
  if (static_cast<uint32_t>(stream.format) > static_cast<uint32_t>(VertexFormat::kHalf4))
    return make_status(kInvalid, "read: format %u of %s does not exist", static_cast<uint32_t>(stream.format),
                       name);
  const size_t alignment = alignment_of(stream.format), bytes = bytes_of(stream.format);
  if (reinterpret_cast<uintptr_t>(stream.out) % alignment != 0)
    return make_status(kInvalid, "read: out of %s is not aligned to %zu bytes", name, alignment);
  if (stream.stride_bytes != 0 && (stream.stride_bytes < bytes || stream.stride_bytes % alignment != 0)) {
    return make_status(kInvalid,
                       "read: stride_bytes of %s is %zu; it must be a multiple of %zu, at least %zu", name,
                       stream.stride_bytes, alignment, bytes);
  }
  return {};
}

}  // namespace

Status check_origin(const double (&origin_m)[3]) noexcept {
  for (double origin : origin_m)
    if (!std::isfinite(origin))
      return make_status(StatusCode::kNotFinite, "read: origin_m holds NaN or infinity");
  return {};
}

Status check_read(const SurfaceReadDef& def, const Asset& asset) noexcept {
  constexpr StatusCode kInvalid = StatusCode::kInvalidArgument;
  if (static_cast<uint32_t>(def.space) > static_cast<uint32_t>(Space::kBind)) {
    return make_status(kInvalid, "read: space %u does not exist", static_cast<uint32_t>(def.space));
  }
  if (!def.positions.out && !def.normals.out && !def.tangents.out)
    return make_status(kInvalid, "read: out of positions, normals and tangents is a null pointer");
  if (Status status = check_stream(def.positions, "positions"); !status.ok()) return status;
  if (Status status = check_stream(def.normals, "normals"); !status.ok()) return status;
  if (Status status = check_stream(def.tangents, "tangents"); !status.ok()) return status;
  if (def.tangents.out && asset.pack.tangents.empty())
    return make_status(kInvalid, "read: the asset has no tangents, as its file has no texture coordinates");
  const uint32_t vertices = def.moved_only ? asset.soft.count : asset.vertex_count();
  if (def.capacity < vertices) {
    return make_status(kInvalid, "read: capacity is %zu, the asset has %u %svertices", def.capacity, vertices,
                       def.moved_only ? "moved " : "");
  }
  return check_origin(def.origin_m);
}

void read_surface(const Instance& instance, const SurfaceReadDef& def) noexcept {
  if (def.normals.out || def.tangents.out)
    write_surface(instance, def);
  else if (def.space == Space::kBind)
    write_bind_deltas(instance, def);
  else
    write_places(instance, def);
}

}  // namespace sinew::world
