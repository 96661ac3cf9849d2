// reduced_network.hpp  Alt-ConvLSTM in fp16 and int8 (pack/format.hpp, Precision): state and one step.
//
// As tissue/network/network.hpp has them in float32, by the same names. The planes of a hidden layer hold
// halves, each to the next multiple of 64 bytes; those of the last layer hold floats.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "baker/research/precision/half.hpp"
#include "baker/research/precision/layer_kernels.hpp"
#include "tissue/network/network.hpp"

namespace sinew::baker {

struct Int8Weights {  // as pack/format.hpp, kInt8Weights, has them
  const int8_t* weights = nullptr;
  const int32_t* sums = nullptr;
  const float* scales = nullptr;
};

struct ReducedNetwork {  // views; trivially copyable. It has at least two layers
  tissue::Network floats;
  Int8Weights int8{};                     // of an int8 network
  const LayerKernels* kernels = nullptr;  // null: the best of layer_kernels()
};

size_t state_floats(const ReducedNetwork& network, uint32_t node_count);
size_t scratch_floats(const ReducedNetwork& network, uint32_t node_count);

struct HalfLayerState {
  Half *h, *c, *y;
};
HalfLayerState hidden_state(const ReducedNetwork& network, uint32_t node_count, uint32_t layer, float* state);
tissue::LayerState last_state(const ReducedNetwork& network, uint32_t node_count, float* state);

// The numbers of any layer's planes, [node_count][padded].
struct LayerValues {
  std::vector<float> h, c, y;
};
LayerValues layer_values(const ReducedNetwork& network, uint32_t node_count, uint32_t layer, float* state);

void network_step(const ReducedNetwork& network, const tissue::Graph& graph, const float* z,
                  const float* carry, float* state, float* scratch);

}  // namespace sinew::baker
