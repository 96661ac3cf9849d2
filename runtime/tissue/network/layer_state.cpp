// layer_state.cpp  see layer_state.hpp.
#include "tissue/network/layer_state.hpp"

namespace sinew::tissue {
namespace {

// Floats that one of a layer's planes takes.
size_t plane_floats(const Network& network, uint32_t node_count, uint32_t layer) {
  return size_t{network.layers[layer].padded} * node_count;
}

}  // namespace

size_t state_floats(const Network& network, uint32_t node_count) noexcept {
  size_t floats = 0;
  for (uint32_t l = 0; l < network.layers.size(); ++l) floats += 3 * plane_floats(network, node_count, l);
  return floats;
}

LayerState layer_state(const Network& network, uint32_t node_count, uint32_t layer, float* state) noexcept {
  for (uint32_t l = 0; l < layer; ++l) state += 3 * plane_floats(network, node_count, l);
  const size_t plane = plane_floats(network, node_count, layer);
  return {state, state + plane, state + 2 * plane};
}

}  // namespace sinew::tissue
