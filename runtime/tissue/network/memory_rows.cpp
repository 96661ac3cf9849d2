// memory_rows.cpp  see memory_rows.hpp.
#include "tissue/network/memory_rows.hpp"

#include <cstring>

#include "pack/format.hpp"
#include "tissue/network/layer_state.hpp"

namespace sinew::tissue {
namespace {

// One of a layer's planes, as bytes.
struct Plane {
  std::byte* at;
  size_t row_bytes;
};

Plane plane_of(const Network& network, uint32_t node_count, uint32_t index, float* state) {
  const uint32_t layer = index / 3;
  const LayerState planes = layer_state(network, node_count, layer, state);
  float* const at[] = {planes.h, planes.c, planes.y};
  return {reinterpret_cast<std::byte*>(at[index % 3]), network.layers[layer].padded * sizeof(float)};
}

uint32_t plane_count(const Network& network) { return 3 * static_cast<uint32_t>(network.layers.size()); }

}  // namespace

// Nothing is written behind where it is still to be read.
void pick_memory(const Network& network, uint32_t node_count, std::span<const uint32_t> picks,
                 float* state) noexcept {
  const auto count = static_cast<uint32_t>(picks.size());
  for (uint32_t index = 0; index < plane_count(network); ++index) {
    const Plane from = plane_of(network, node_count, index, state),
                to = plane_of(network, count, index, state);
    for (size_t n = 0; n < count; ++n)
      std::memmove(to.at + n * to.row_bytes, from.at + picks[n] * from.row_bytes, to.row_bytes);
  }
}

// From the last plane on, so that those before it lie where they lay.
void copy_memory(const Network& network, uint32_t node_count, std::span<const uint32_t> sources, float* state,
                 float* scratch) noexcept {
  const auto count = static_cast<uint32_t>(sources.size());
  const auto* kept = reinterpret_cast<const std::byte*>(scratch);
  for (uint32_t index = plane_count(network); index-- > 0;) {
    const Plane from = plane_of(network, node_count, index, state),
                to = plane_of(network, count, index, state);
    std::memcpy(scratch, from.at, node_count * from.row_bytes);
    for (size_t n = 0; n < count; ++n) {
      if (sources[n] == pack::kNoIndex)
        std::memset(to.at + n * to.row_bytes, 0, to.row_bytes);
      else
        std::memcpy(to.at + n * to.row_bytes, kept + sources[n] * from.row_bytes, to.row_bytes);
    }
  }
}

}  // namespace sinew::tissue
