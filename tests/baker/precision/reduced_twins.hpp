// reduced_twins.hpp  Networks in fp16 and int8 beside the same in double.
#pragma once
#include "baker/research/precision/reduced_network.hpp"
#include "tests/tissue/network_twins.hpp"

namespace sinew::baker {

inline LayerValues values_of(const ReducedNetwork& network, uint32_t nodes, uint32_t layer, float* state) {
  return layer_values(network, nodes, layer, state);
}

}  // namespace sinew::baker
