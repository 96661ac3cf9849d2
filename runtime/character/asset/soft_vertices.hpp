// soft_vertices.hpp  The vertices that regions carry, each once, and where in `carried` each is.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "pack/pack_view.hpp"
#include "sinew/status.hpp"

namespace sinew::world {

struct SoftVertices {
  // Of one region that carries a vertex, in Published::carried: x, and y and z `pitch` further each.
  struct Place {
    uint32_t first, pitch;
  };
  std::unique_ptr<uint32_t[]> vertices;     // [count], ascending
  std::unique_ptr<uint32_t[]> first_place;  // [count + 1]
  std::unique_ptr<Place[]> places;          // vertex after vertex, regions in their order
  std::unique_ptr<uint32_t[]> most_shared;  // [regions]: by how many its vertices are carried, at most
  uint32_t count = 0;

  std::span<const uint32_t> all() const noexcept { return {vertices.get(), count}; }
  std::span<const Place> places_of(size_t slot) const noexcept {
    return {places.get() + first_place[slot], first_place[slot + 1] - first_place[slot]};
  }
  // Of a vertex; `count` where nothing carries it.
  uint32_t slot_of(uint32_t vertex) const noexcept;
};

// kOutOfCapacity: no memory.
Status find_soft_vertices(const pack::PackView& pack, SoftVertices* out) noexcept;

}  // namespace sinew::world
