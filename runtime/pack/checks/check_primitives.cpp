// check_primitives.cpp  Primitives have all vertices and triangles, in order and inside of their meshes;
// tangents are unit vectors with a side.
#include <algorithm>

#include "pack/checks/checks.hpp"

namespace sinew::pack {
namespace {

// What the primitives so far have.
struct Covered {
  uint64_t vertices = 0, triangles = 0;
};

Status check_place(const PackView& pack, size_t index) noexcept {
  const PrimitiveRecord& primitive = pack.primitives[index];
  if (primitive.mesh >= pack.meshes.size())
    return corrupt("primitive %zu: mesh %u of %zu", index, primitive.mesh, pack.meshes.size());
  if (index > 0) {
    const PrimitiveRecord& last = pack.primitives[index - 1];
    if (primitive.mesh < last.mesh)
      return corrupt("primitive %zu: its mesh comes before that of the primitive before it", index);
    if (primitive.mesh == last.mesh && primitive.index <= last.index)
      return corrupt("primitive %zu: index %u does not ascend in its mesh", index, primitive.index);
  }
  if (primitive.material != kNoIndex && primitive.material >= pack.strings.size())
    return corrupt("primitive %zu: its material's name lies outside the strings", index);
  return {};
}

Status check_shared(const PackView& pack, size_t index) noexcept {
  const PrimitiveRecord& primitive = pack.primitives[index];
  const uint32_t owner = primitive.sharer - 1;
  if (owner >= index)
    return corrupt("primitive %zu: shares with %u, which does not come before it", index, owner);
  const PrimitiveRecord& other = pack.primitives[owner];
  if (other.sharer != 0 || other.mesh != primitive.mesh || other.first_vertex != primitive.first_vertex ||
      other.vertex_count != primitive.vertex_count)
    return corrupt("primitive %zu: its vertices are not those of primitive %u, with which it shares them",
                   index, owner);
  return {};
}

Status check_vertices(const PackView& pack, size_t index, Covered* covered) noexcept {
  const PrimitiveRecord& primitive = pack.primitives[index];
  if (primitive.sharer != 0) return check_shared(pack, index);
  const MeshRecord& mesh = pack.meshes[primitive.mesh];
  if (primitive.first_vertex != covered->vertices)
    return corrupt("primitive %zu: its vertices do not follow those before it", index);
  covered->vertices += primitive.vertex_count;
  if (primitive.first_vertex < mesh.first_vertex ||
      covered->vertices > uint64_t{mesh.first_vertex} + mesh.vertex_count)
    return corrupt("primitive %zu: its vertices lie outside of mesh %u", index, primitive.mesh);
  return {};
}

Status check_triangles(const PackView& pack, size_t index, Covered* covered) noexcept {
  const PrimitiveRecord& primitive = pack.primitives[index];
  if (primitive.first_triangle != covered->triangles)
    return corrupt("primitive %zu: its triangles do not follow those before it", index);
  covered->triangles += primitive.triangle_count;
  if (covered->triangles > pack.character->triangle_count)
    return corrupt("primitive %zu: its triangles are more than there are", index);
  const std::span<const uint32_t> corners =
      pack.triangles.subspan(3 * size_t{primitive.first_triangle}, 3 * size_t{primitive.triangle_count});
  const auto is_own = [&](uint32_t corner) {
    return corner >= primitive.first_vertex && corner - primitive.first_vertex < primitive.vertex_count;
  };
  return std::ranges::all_of(corners, is_own)
             ? Status{}
             : corrupt("primitive %zu: a triangle has a vertex that is not its own", index);
}

Status check_all_covered(const PackView& pack, const Covered& covered) noexcept {
  const CharacterRecord& record = *pack.character;
  if (covered.vertices == record.vertex_count && covered.triangles == record.triangle_count) return {};
  return corrupt("primitives: have %llu vertices and %llu triangles, the character %u and %u",
                 static_cast<unsigned long long>(covered.vertices),
                 static_cast<unsigned long long>(covered.triangles), record.vertex_count,
                 record.triangle_count);
}

Status check_tangents(const PackView& pack) noexcept {
  if (pack.tangents.empty()) return {};
  const uint64_t vertices = pack.character->vertex_count;
  if (pack.tangents.size() != 4 * vertices)
    return corrupt("tangents: %zu numbers for %llu vertices", pack.tangents.size(),
                   static_cast<unsigned long long>(vertices));
  for (size_t vertex = 0; vertex < vertices; ++vertex) {
    const float* tangent = &pack.tangents[4 * vertex];
    if (!is_unit(tangent)) return corrupt("vertex %zu: tangent is not a unit vector", vertex);
    if (tangent[3] != 1 && tangent[3] != -1)
      return corrupt("vertex %zu: its tangent's w is %g, neither 1 nor -1", vertex, double{tangent[3]});
  }
  return {};
}

}  // namespace

Status check_primitives(const PackView& pack) noexcept {
  Covered covered;
  for (size_t index = 0; index < pack.primitives.size(); ++index) {
    if (Status status = check_place(pack, index); !status.ok()) return status;
    if (Status status = check_vertices(pack, index, &covered); !status.ok()) return status;
    if (Status status = check_triangles(pack, index, &covered); !status.ok()) return status;
  }
  if (Status status = check_all_covered(pack, covered); !status.ok()) return status;
  return check_tangents(pack);
}

}  // namespace sinew::pack
