// narrow_layer.hpp  Layers of at most eight channels: their weights packed once, and what they hear gathered
// at a step's start (kernels/network/narrow-inl.hpp).
//
// A pack's weights are in one layout, 16 floats a gate (pack/format.hpp).
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/kernels.hpp"
#include "tissue/network/network_weights.hpp"

namespace sinew::tissue {

// Weights of all narrow layers, 64-byte aligned: Network::narrow, made by whoever opens a network.
size_t narrow_floats(const Network& network) noexcept;
void pack_narrow(const Network& network, float* packed) noexcept;

// Of what hear_narrow fills.
size_t heard_floats(const Network& network, uint32_t node_count) noexcept;
// Fills heard with P h of all narrow layers, and P y if the last is one, of nodes first..last.
void hear_narrow(const Network& network, const Graph& graph, float* state, uint32_t first, uint32_t last,
                 float* heard) noexcept;
// Nothing but gate_width, which becomes 0, where layer l is not narrow.
void set_narrow(const Network& network, uint32_t node_count, uint32_t l, const float* heard,
                simd::LayerJob* job) noexcept;

}  // namespace sinew::tissue
