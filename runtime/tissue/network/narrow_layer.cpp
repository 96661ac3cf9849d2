// narrow_layer.cpp  see narrow_layer.hpp.
#include "tissue/network/narrow_layer.hpp"

#include <algorithm>

#include "tissue/network/layer_state.hpp"

namespace sinew::tissue {
namespace {

using simd::kBlock;

constexpr uint32_t kGates = 4, kPeepholes = 2;  // W_y: gates i and f, o behind them

uint32_t gate_width(const Network& network, uint32_t l) {
  const uint32_t channels = network.layers[l].channels;
  return channels > 8 ? 0 : channels <= 4 ? 4 : 8;
}

size_t packed_rows(const pack::LayerRecord& layer) {
  return 1 + size_t{layer.inputs} * (layer.has_self ? 2 : 1) + 2 * size_t{layer.channels};
}

size_t packed_floats(const Network& network, uint32_t l) {
  return packed_rows(network.layers[l]) * kGates * gate_width(network, l);
}

bool is_last(const Network& network, uint32_t l) { return l + 1 == network.layers.size(); }

// Planes that layer l hears: P h, and P y of the last.
uint32_t heard_planes(const Network& network, uint32_t l) {
  if (gate_width(network, l) == 0) return 0;
  return is_last(network, l) ? 2 : 1;
}

// Rows of `given` gates of kBlock floats to rows of four of `width`; the other gates are zero.
float* pack_rows(const float* rows, size_t count, uint32_t given, uint32_t width, float* out) {
  for (size_t row = 0; row < count; ++row, rows += size_t{given} * kBlock, out += size_t{kGates} * width) {
    std::fill_n(out, kGates * width, 0.0f);
    for (uint32_t gate = 0; gate < given; ++gate)
      std::copy_n(rows + size_t{gate} * kBlock, width, out + size_t{gate} * width);
  }
  return out;
}

float* pack_layer(const pack::LayerRecord& layer, uint32_t width, const float* weights, float* out) {
  const auto all = [&](uint64_t at, size_t rows) { out = pack_rows(weights + at, rows, kGates, width, out); };
  all(layer.bias, 1);
  all(layer.w_x, layer.inputs);
  if (layer.has_self) all(layer.w_s, layer.inputs);
  all(layer.w_h, layer.channels);
  return pack_rows(weights + layer.w_y, layer.channels, kPeepholes, width, out);
}

}  // namespace

size_t narrow_floats(const Network& network) noexcept {
  size_t floats = 0;
  for (uint32_t l = 0; l < network.layers.size(); ++l) floats += packed_floats(network, l);
  return floats;
}

size_t heard_floats(const Network& network, uint32_t node_count) noexcept {
  size_t planes = 0;
  for (uint32_t l = 0; l < network.layers.size(); ++l) planes += heard_planes(network, l);
  return planes * kBlock * node_count;
}

void pack_narrow(const Network& network, float* packed) noexcept {
  for (uint32_t l = 0; l < network.layers.size(); ++l) {
    const uint32_t width = gate_width(network, l);
    if (width > 0) packed = pack_layer(network.layers[l], width, network.weights, packed);
  }
}

void hear_narrow(const Network& network, const Graph& graph, float* state, uint32_t first, uint32_t last,
                 float* heard) noexcept {
  constexpr uint32_t kAtOnce = 4;
  const float* planes[kAtOnce];
  float* out[kAtOnce];
  uint32_t count = 0;
  const auto flush = [&] {
    simd::kernels().aggregate_planes({graph.rows, graph.columns, graph.values}, planes, count, first, last,
                                     out);
    count = 0;
  };
  for (uint32_t l = 0; l < network.layers.size(); ++l) {
    if (heard_planes(network, l) == 0) continue;
    const LayerState layer = layer_state(network, graph.node_count, l, state);
    const float* const heard_of[] = {layer.h, layer.y};
    for (uint32_t plane = 0; plane < heard_planes(network, l); ++plane) {
      planes[count] = heard_of[plane];
      out[count++] = heard;
      heard += size_t{kBlock} * graph.node_count;
      if (count == kAtOnce) flush();
    }
  }
  flush();
}

void set_narrow(const Network& network, uint32_t node_count, uint32_t l, const float* heard,
                simd::LayerJob* job) noexcept {
  job->gate_width = gate_width(network, l);
  if (job->gate_width == 0) return;
  const size_t plane = size_t{kBlock} * node_count;
  const float* packed = network.narrow;
  for (uint32_t before = 0; before < l; ++before) {
    heard += heard_planes(network, before) * plane;
    packed += packed_floats(network, before);
  }
  job->packed = packed;
  job->ph = heard;
  job->py = is_last(network, l) ? heard + plane : nullptr;
}

}  // namespace sinew::tissue
