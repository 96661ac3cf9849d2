// network.cpp  Walks the layers of an Alt-ConvLSTM; the arithmetic is kernels/network/layer-inl.hpp.
#include "tissue/network/network.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/kernels.hpp"
#include "tissue/network/narrow_layer.hpp"

namespace sinew::tissue {
namespace {

using simd::kRangeNodes;
using simd::pad_to_block;

// Output gates of two neighbouring layers, y_next of the last, what narrow layers hear, P x of a range and
// one tile; in floats.
struct Scratch {
  size_t gates, y_next, heard, px, tile;
  size_t all() const { return 2 * gates + y_next + heard + px + tile; }
};

Scratch scratch_of(const Network& network, uint32_t node_count) {
  size_t widest = 0, last = 0;
  for (const pack::LayerRecord& layer : network.layers) {
    last = layer.padded;
    widest = std::max(widest, last);
  }
  const size_t inputs = std::max(widest, pad_to_block(network.record->input_width));
  return {widest * node_count, last * node_count, heard_floats(network, node_count), inputs * kRangeNodes,
          simd::tile_floats(static_cast<uint32_t>(widest))};
}

// What network_step is given.
struct Step {
  const Network& network;
  const Graph& graph;
  const float *z, *carry;
  float *state, *scratch;
  Scratch sizes = scratch_of(network, graph.node_count);
  float* y_next() const { return scratch + 2 * sizes.gates; }
  float* heard() const { return y_next() + sizes.y_next; }
  float* px() const { return heard() + sizes.heard; }
};

void set_weights(const Network& network, const pack::LayerRecord& layer, simd::LayerJob* job) {
  const float* weights = network.weights;
  job->inputs = layer.inputs;
  job->channels = layer.channels;
  job->padded = layer.padded;
  job->w_x = weights + layer.w_x;
  job->w_s = layer.has_self ? weights + layer.w_s : nullptr;
  job->w_h = weights + layer.w_h;
  job->w_y = weights + layer.w_y;
  job->bias = weights + layer.bias;
}

// The last layer accumulates the output; the others only remember.
void set_accumulation(const Step& step, bool is_last, float* y_next, simd::LayerJob* job) {
  const pack::NetworkRecord& record = *step.network.record;
  job->clamp = record.state_clamp;
  job->y_keep = 1 - (is_last ? record.output_leak : record.hidden_leak);
  job->y_gain = is_last ? record.output_scale : 1;
  job->carry = is_last ? step.carry : nullptr;
  job->y_next = is_last ? y_next : nullptr;
}

simd::LayerJob job_of(const Step& step, uint32_t l) {
  const uint32_t nodes = step.graph.node_count;
  const LayerState state = layer_state(step.network, nodes, l, step.state);
  simd::LayerJob job{.graph = {step.graph.rows, step.graph.columns, step.graph.values}};
  set_weights(step.network, step.network.layers[l], &job);
  set_accumulation(step, l + 1 == step.network.layers.size(), step.y_next(), &job);
  job.x = l == 0 ? step.z : layer_state(step.network, nodes, l - 1, step.state).c;
  job.x_stride = pad_to_block(job.inputs);
  job.px = job.pc = step.px();  // P x of a layer is P c of the one before
  job.h = state.h;
  job.c = state.c;
  job.y = state.y;
  job.output_gate = step.scratch + l % 2 * step.sizes.gates;
  job.tile = step.px() + step.sizes.px;
  set_narrow(step.network, nodes, l, step.heard(), &job);
  return job;
}

void run_cells(const simd::LayerJob& job, uint32_t first, uint32_t last) {
  const simd::Kernels& kernels = simd::kernels();
  (job.gate_width > 0 ? kernels.narrow_cells : kernels.layer_cells)(job, first, last);
}

void run_output(const simd::LayerJob& job, uint32_t first, uint32_t last) {
  const simd::Kernels& kernels = simd::kernels();
  (job.gate_width > 0 ? kernels.narrow_output : kernels.layer_output)(job, first, last);
}

// Nodes first..last through the second pass of the layer before l and the first of l: what the one leaves in
// cache the other takes.
void layer_step(const Step& step, uint32_t l, uint32_t first_node, uint32_t last_node) {
  const simd::Kernels& kernels = simd::kernels();
  const auto layers = static_cast<uint32_t>(step.network.layers.size());
  const simd::LayerJob before = job_of(step, l == 0 ? 0 : l - 1), now = job_of(step, l < layers ? l : 0);
  if (l == 0) hear_narrow(step.network, step.graph, step.state, first_node, last_node, step.heard());
  for (uint32_t first = first_node; first < last_node; first += kRangeNodes) {
    const uint32_t last = std::min(first + kRangeNodes, last_node);
    if (l == 0) kernels.aggregate(now.graph, step.z, now.x_stride, first, last, now.pc);
    if (l > 0) run_output(before, first, last);
    if (l < layers) run_cells(now, first, last);
  }
}

// A NaN is kept.
float largest_magnitude(const float* values, size_t count) {
  float largest = 0;
  for (size_t i = 0; i < count && !std::isnan(largest); ++i) {
    const float magnitude = std::fabs(values[i]);
    if (!(magnitude <= largest)) largest = magnitude;
  }
  return largest;
}

}  // namespace

size_t scratch_floats(const Network& network, uint32_t node_count) noexcept {
  return scratch_of(network, node_count).all();
}

void network_step(const Network& network, const Graph& graph, const float* z, const float* carry,
                  float* state, float* scratch) noexcept {
  const NodeRun all = {0, graph.node_count};
  network_step(network, graph, {&all, 1}, z, carry, state, scratch);
}

void network_step(const Network& network, const Graph& graph, std::span<const NodeRun> runs, const float* z,
                  const float* carry, float* state, float* scratch) noexcept {
  const Step step = {network, graph, z, carry, state, scratch};
  for (uint32_t l = 0; l <= network.layers.size(); ++l) {
    for (const NodeRun& run : runs) layer_step(step, l, run.first, run.last);
  }
}

float largest_cell(const Network& network, uint32_t node_count, const float* state) noexcept {
  float largest = 0;
  for (uint32_t l = 0; l < network.layers.size(); ++l) {
    float* c = layer_state(network, node_count, l, const_cast<float*>(state)).c;
    const float in_layer = largest_magnitude(c, size_t{network.layers[l].padded} * node_count);
    if (!(in_layer <= largest)) largest = in_layer;
    if (std::isnan(largest)) return largest;
  }
  return largest;
}

}  // namespace sinew::tissue
