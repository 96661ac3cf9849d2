// narrow_layer.hpp  Layers of at most eight channels: their weights packed anew for each
// step, and what they hear gathered at its start (simd/narrow-inl.hpp).
//
// A pack's weights are in one layout, 16 floats a gate (pack/format.hpp). Packing a layer of 8 channels and
// 56 inputs moves 16 KB a step.
#pragma once
#include <cstddef>
#include <cstdint>

#include "simd/kernels.hpp"
#include "tissue/network.hpp"

namespace sinew::tissue {

struct NarrowScratch {  // floats
  size_t heard = 0, packed_floats = 0;
};
NarrowScratch narrow_scratch(const Network& network, uint32_t node_count) noexcept;

// Fills packed with the weights of all narrow layers.
void pack_narrow(const Network& network, float* packed) noexcept;
// Fills heard with P h of all narrow layers, and P y if the last is one, of nodes first..last.
void hear_narrow(const Network& network, const Graph& graph, float* state, uint32_t first, uint32_t last,
                 float* heard) noexcept;
// Nothing but gate_width, which becomes 0, where layer l is not narrow.
void set_narrow(const Network& network, uint32_t node_count, uint32_t l, const float* heard,
                const float* packed, simd::LayerJob* job) noexcept;

}  // namespace sinew::tissue
