// network_weights.hpp  The graph and the weights of an Alt-ConvLSTM, as views.
#pragma once
#include <cstdint>
#include <span>

#include "pack/format.hpp"

namespace sinew::tissue {

struct Graph {  // P in CSR, nodes x nodes
  uint32_t node_count = 0;
  const uint32_t* rows = nullptr;  // [node_count + 1]
  const uint32_t* columns = nullptr;
  const float* values = nullptr;
};

struct Network {  // views into a pack, of float32, and of what is packed once; trivially copyable
  const pack::NetworkRecord* record = nullptr;
  std::span<const pack::LayerRecord> layers;
  std::span<const pack::InputRecord> inputs;
  const float* weights = nullptr;
  const float* narrow = nullptr;  // tissue/network/narrow_layer.hpp
};

// Nodes that no edge of the graph leaves.
struct NodeRun {
  uint32_t first, last;
};

}  // namespace sinew::tissue
