// network.cpp  Walks the layers of an Alt-ConvLSTM; the arithmetic is simd/layer-inl.hpp.
#include "tissue/network.hpp"

#include <algorithm>
#include <cmath>

#include "simd/kernels.hpp"

namespace sinew::tissue {
namespace {

using simd::pad_to_block;

// Scratch: y_next and the output gate's sums of the widest layer, then one tile.
struct Scratch {
  size_t row_floats;  // of one node in the widest layer
  size_t tile_floats;
};

Scratch scratch_of(const Network& network) {
  Scratch scratch{};
  for (const pack::LayerRecord& layer : network.layers) {
    scratch.row_floats = std::max<size_t>(scratch.row_floats, layer.padded);
    scratch.tile_floats = std::max(scratch.tile_floats, simd::tile_floats(layer.inputs, layer.padded));
  }
  return scratch;
}

simd::LayerJob layer_job(const Network& network, const pack::LayerRecord& layer, const Graph& graph,
                         const LayerState& state) {
  const float* weights = network.weights;
  return {.graph = {graph.rows, graph.columns, graph.values},
          .inputs = layer.inputs,
          .channels = layer.channels,
          .padded = layer.padded,
          .w_x = weights + layer.w_x,
          .w_s = layer.has_self ? weights + layer.w_s : nullptr,
          .w_h = weights + layer.w_h,
          .w_y = weights + layer.w_y,
          .bias = weights + layer.bias,
          .h = state.h,
          .c = state.c,
          .y = state.y,
          .clamp = network.record->state_clamp};
}

// The last layer accumulates the output; the others only remember.
void set_accumulation(const pack::NetworkRecord& record, bool is_last, const float* carry,
                      simd::LayerJob* job) {
  job->y_keep = 1 - (is_last ? record.output_leak : record.hidden_leak);
  job->y_gain = is_last ? record.output_scale : 1;
  job->carry = is_last ? carry : nullptr;
}

}  // namespace

size_t state_floats(const Network& network, uint32_t node_count) noexcept {
  size_t row = 0;
  for (const pack::LayerRecord& layer : network.layers) row += 3 * size_t{layer.padded};
  return row * node_count;
}

size_t scratch_floats(const Network& network, uint32_t node_count) noexcept {
  const Scratch scratch = scratch_of(network);
  return 2 * scratch.row_floats * node_count + scratch.tile_floats;
}

LayerState layer_state(const Network& network, uint32_t node_count, uint32_t layer, float* state) noexcept {
  for (uint32_t l = 0; l < layer; ++l) state += 3 * size_t{network.layers[l].padded} * node_count;
  const size_t plane = size_t{network.layers[layer].padded} * node_count;
  return {state, state + plane, state + 2 * plane};
}

void network_step(const Network& network, const Graph& graph, const float* z, const float* carry,
                  float* state, float* scratch) noexcept {
  const simd::Kernels& kernels = simd::kernels();
  const uint32_t nodes = graph.node_count;
  const size_t plane = scratch_of(network).row_floats * nodes;
  const float* x = z;
  size_t x_stride = pad_to_block(network.record->input_width);
  for (uint32_t l = 0; l < network.layers.size(); ++l) {
    simd::LayerJob job = layer_job(network, network.layers[l], graph, layer_state(network, nodes, l, state));
    set_accumulation(*network.record, l + 1 == network.layers.size(), carry, &job);
    job.x = x;
    job.x_stride = x_stride;
    job.y_next = scratch;
    job.output_gate = scratch + plane;
    job.tile = scratch + 2 * plane;
    kernels.layer_cells(job, 0, nodes);
    kernels.layer_output(job, 0, nodes);
    x = job.c;
    x_stride = job.padded;
  }
}

float largest_cell(const Network& network, uint32_t node_count, const float* state) noexcept {
  float largest = 0;
  for (uint32_t l = 0; l < network.layers.size(); ++l) {
    const float* c = layer_state(network, node_count, l, const_cast<float*>(state)).c;
    const size_t count = size_t{network.layers[l].padded} * node_count;
    for (size_t i = 0; i < count; ++i) {
      const float magnitude = std::fabs(c[i]);
      if (!(magnitude <= largest)) largest = magnitude;  // a NaN is kept
      if (std::isnan(largest)) return largest;
    }
  }
  return largest;
}

}  // namespace sinew::tissue
