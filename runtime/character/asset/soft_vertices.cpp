// soft_vertices.cpp  see soft_vertices.hpp.
#include "character/asset/soft_vertices.hpp"

#include <algorithm>
#include <new>

#include "core/status.hpp"

namespace sinew::world {

uint32_t SoftVertices::slot_of(uint32_t vertex) const noexcept {
  const uint32_t* begin = vertices.get();
  const uint32_t* at = std::lower_bound(begin, begin + count, vertex);
  return at != begin + count && *at == vertex ? static_cast<uint32_t>(at - begin) : count;
}

Status find_soft_vertices(const pack::PackView& pack, SoftVertices* out) noexcept {
  const size_t carried = pack.region_vertices.size();
  SoftVertices soft;
  soft.vertices.reset(new (std::nothrow) uint32_t[carried + 1]);
  soft.first_place.reset(new (std::nothrow) uint32_t[carried + 2]());
  soft.places.reset(new (std::nothrow) SoftVertices::Place[carried + 1]);
  soft.most_shared.reset(new (std::nothrow) uint32_t[pack.regions.size() + 1]());
  if (!soft.vertices || !soft.first_place || !soft.places || !soft.most_shared)
    return core::make_status(StatusCode::kOutOfCapacity, "asset: no memory for its soft vertices");
  uint32_t* end = std::copy_n(pack.region_vertices.data(), carried, soft.vertices.get());
  std::sort(soft.vertices.get(), end);
  soft.count = static_cast<uint32_t>(std::unique(soft.vertices.get(), end) - soft.vertices.get());
  // Counted two places on, so that filling them in leaves each one's begin where it belongs.
  for (const uint32_t vertex : pack.region_vertices) ++soft.first_place[soft.slot_of(vertex) + 2];
  for (uint32_t slot = 1; slot <= soft.count; ++slot) soft.first_place[slot + 1] += soft.first_place[slot];
  uint32_t first = 0;
  for (const pack::RegionRecord& region : pack.regions) {
    for (uint32_t column = 0; column < region.vertex_count; ++column) {
      const uint32_t slot = soft.slot_of(pack.region_vertices[region.first_vertex + column]);
      soft.places[soft.first_place[slot + 1]++] = {first + column, region.padded_vertices};
    }
    first += 3 * region.padded_vertices;
  }
  for (size_t r = 0; r < pack.regions.size(); ++r) {
    uint32_t& most = soft.most_shared[r] = 1;
    for (const uint32_t vertex :
         pack.region_vertices.subspan(pack.regions[r].first_vertex, pack.regions[r].vertex_count))
      most = std::max(most, static_cast<uint32_t>(soft.places_of(soft.slot_of(vertex)).size()));
  }
  *out = std::move(soft);
  return {};
}

}  // namespace sinew::world
