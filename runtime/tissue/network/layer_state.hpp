// layer_state.hpp  What an Alt-ConvLSTM remembers: where each layer's planes lie.
#pragma once
#include <cstddef>
#include <cstdint>

#include "tissue/network/network_weights.hpp"

namespace sinew::tissue {

// Floats of state for node_count nodes: for each layer h, c, y as [node_count][padded], where y of a hidden
// layer is P y, for it is heard through P only. 64-byte aligned, zero is the start (the paper's wiring: y of
// the last layer starts at Y_0).
size_t state_floats(const Network& network, uint32_t node_count) noexcept;

struct LayerState {
  float* h;
  float* c;
  float* y;
};
LayerState layer_state(const Network& network, uint32_t node_count, uint32_t layer, float* state) noexcept;

}  // namespace sinew::tissue
