// memory_rows.hpp  A network's memory on other nodes than it was made on.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "tissue/network/network_weights.hpp"

namespace sinew::tissue {

// state of node_count nodes becomes that of picks.size(): node n has what picks[n] had. Picks ascend.
void pick_memory(const Network& network, uint32_t node_count, std::span<const uint32_t> picks,
                 float* state) noexcept;
// Becomes that of sources.size() nodes, more than before: node n has what sources[n] had, kNoIndex: nothing.
// scratch: [node_count][max_channels, padded], 64-byte aligned.
void copy_memory(const Network& network, uint32_t node_count, std::span<const uint32_t> sources, float* state,
                 float* scratch) noexcept;

}  // namespace sinew::tissue
