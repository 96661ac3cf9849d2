// reduced_network.cpp  Walks the layers of an Alt-ConvLSTM in fp16 or int8.
#include "baker/research/precision/reduced_network.hpp"

#include <algorithm>

#include "baker/pack/network/int8_layout.hpp"

namespace sinew::baker {
namespace {

using simd::kRangeNodes;
using simd::LayerJobOf;
using simd::pad_to_block;

constexpr size_t kLineFloats = 16;

uint32_t layer_count(const ReducedNetwork& network) {
  return static_cast<uint32_t>(network.floats.layers.size());
}

bool is_last(const ReducedNetwork& network, uint32_t layer) { return layer + 1 == layer_count(network); }

// Floats that one of a layer's planes takes.
size_t plane_floats(const ReducedNetwork& network, uint32_t node_count, uint32_t layer) {
  const size_t count = size_t{network.floats.layers[layer].padded} * node_count;
  return is_last(network, layer) ? count : (count / 2 + kLineFloats - 1) / kLineFloats * kLineFloats;
}

// A layer's h, c and y.
template <class T>
struct Planes {
  T *h, *c, *y;
};

template <class T>
Planes<T> planes_of(const ReducedNetwork& network, uint32_t node_count, uint32_t layer, float* state) {
  for (uint32_t l = 0; l < layer; ++l) state += 3 * plane_floats(network, node_count, l);
  const size_t plane = plane_floats(network, node_count, layer);
  const auto at = [&](size_t index) { return reinterpret_cast<T*>(state + index * plane); };
  return {at(0), at(1), at(2)};
}

// Output gates of two neighbouring layers, y_next of the last, P x of a range and one tile; in floats.
struct Scratch {
  size_t gates, y_next, px, tile;
};

Scratch scratch_of(const ReducedNetwork& network, uint32_t node_count) {
  size_t widest = 0;
  for (const pack::LayerRecord& layer : network.floats.layers)
    widest = std::max<size_t>(widest, layer.padded);
  const size_t inputs = std::max(widest, pad_to_block(network.floats.record->input_width));
  return {widest * node_count, size_t{network.floats.layers.back().padded} * node_count, inputs * kRangeNodes,
          simd::tile_floats(static_cast<uint32_t>(widest))};
}

const LayerKernels& best_kernels() {
  static const LayerKernels& best = *layer_kernels().front();
  return best;
}

// What network_step is given.
struct Step {
  const ReducedNetwork& network;
  const tissue::Graph& graph;
  const float *z, *carry;
  float *state, *scratch;
  const LayerKernels& kernels = network.kernels ? *network.kernels : best_kernels();
  Scratch sizes = scratch_of(network, graph.node_count);
  float* y_next() const { return scratch + 2 * sizes.gates; }
  float* px() const { return y_next() + sizes.y_next; }
  float* tile() const { return px() + sizes.px; }
  template <class T>
  Planes<T> planes(uint32_t layer) const {
    return planes_of<T>(network, graph.node_count, layer, state);
  }
};

void set_x(const Step& step, uint32_t, const float** x) { *x = step.z; }
void set_x(const Step& step, uint32_t l, const Half** x) { *x = step.planes<Half>(l - 1).c; }

// The last layer accumulates the output; the others only remember.
template <class Job>
void set_accumulation(const Step& step, uint32_t l, Job* job) {
  const pack::NetworkRecord& record = *step.network.floats.record;
  const bool last = is_last(step.network, l);
  job->clamp = record.state_clamp;
  job->y_keep = 1 - (last ? record.output_leak : record.hidden_leak);
  job->y_gain = last ? record.output_scale : 1;
  job->carry = last ? step.carry : nullptr;
  job->y_next = last ? step.y_next() : nullptr;
}

template <class X, class T>
void set_job(const Step& step, uint32_t l, LayerJobOf<X, T>* job) {
  const pack::LayerRecord& layer = step.network.floats.layers[l];
  const float* weights = step.network.floats.weights;
  job->graph = {step.graph.rows, step.graph.columns, step.graph.values};
  job->inputs = layer.inputs;
  job->channels = layer.channels;
  job->padded = layer.padded;
  job->w_x = weights + layer.w_x;
  job->w_s = layer.has_self ? weights + layer.w_s : nullptr;
  job->w_h = weights + layer.w_h;
  job->w_y = weights + layer.w_y;
  job->bias = weights + layer.bias;
  set_accumulation(step, l, job);
  set_x(step, l, &job->x);
  const Planes<T> state = step.planes<T>(l);
  job->h = state.h;
  job->c = state.c;
  job->y = state.y;
  job->x_stride = pad_to_block(layer.inputs);
  job->px = job->pc = step.px();  // P x of a layer is P c of the one before
  job->output_gate = step.scratch + l % 2 * step.sizes.gates;
  job->tile = step.tile();
}

Int8Layer int8_layer(const ReducedNetwork& network, uint32_t layer) {
  Int8Weights at = network.int8;
  for (uint32_t l = 0; l < layer; ++l) {
    const Int8Extent before = int8_extent(network.floats.layers[l], l == 0);
    at = {at.weights + before.weights, at.sums + before.sums, at.scales + before.scales};
  }
  const Int8Extent extent = int8_extent(network.floats.layers[layer], layer == 0);
  const size_t p = network.floats.layers[layer].padded;
  return {.w = at.weights,
          .w_o = at.weights + extent.weights - p * p,
          .sums = at.sums,
          .scale = at.scales + extent.depth,
          .per_unit = at.scales,
          .depth = extent.depth};
}

template <class Job, class Use>
void use_layer(const Step& step, uint32_t l, const LayerPasses<Job>& passes, const Use& use) {
  Job job;
  set_job(step, l, &job);
  if constexpr (requires { job.int8; }) job.int8 = int8_layer(step.network, l);
  use(passes, job);
}

// use(passes, job) of layer l, as it is kept and multiplied.
template <class Use>
void with_layer(const Step& step, uint32_t l, const Use& use) {
  const bool bytes = step.network.floats.record->precision == pack::Precision::kInt8;
  if (is_last(step.network, l)) return use_layer(step, l, step.kernels.last, use);
  if (bytes && l == 0) return use_layer(step, l, step.kernels.int8_first, use);
  if (bytes) return use_layer(step, l, step.kernels.int8_hidden, use);
  if (l == 0) return use_layer(step, l, step.kernels.first, use);
  use_layer(step, l, step.kernels.hidden, use);
}

template <class Use>
void over_ranges(const Step& step, const Use& use) {
  for (uint32_t first = 0; first < step.graph.node_count; first += kRangeNodes)
    use(first, std::min(first + kRangeNodes, step.graph.node_count));
}

void begin(const Step& step) {
  with_layer(step, 0, [&](const auto& passes, const auto& job) {
    over_ranges(step, [&](uint32_t first, uint32_t last) {
      simd::kernels().aggregate(job.graph, step.z, job.x_stride, first, last, job.pc);
      passes.cells(job, first, last);
    });
  });
}

// The second pass of a layer and the first of the next: what the one leaves in cache the other takes.
void go_on(const Step& step, uint32_t l) {
  with_layer(step, l, [&](const auto& passes, const auto& job) {
    with_layer(step, l + 1, [&](const auto& next_passes, const auto& next) {
      over_ranges(step, [&](uint32_t first, uint32_t last) {
        passes.output(job, first, last);
        next_passes.cells(next, first, last);
      });
    });
  });
}

void end(const Step& step) {
  with_layer(step, layer_count(step.network) - 1, [&](const auto& passes, const auto& job) {
    over_ranges(step, [&](uint32_t first, uint32_t last) { passes.output(job, first, last); });
  });
}

template <class T>
LayerValues values_of(const Planes<T>& planes, size_t count) {
  const auto all = [&](const T* plane) {
    std::vector<float> out;
    for (size_t k = 0; k < count; ++k) {
      if constexpr (sizeof(T) == sizeof(Half)) out.push_back(half_to_float(plane[k]));
      if constexpr (sizeof(T) != sizeof(Half)) out.push_back(plane[k]);
    }
    return out;
  };
  return {all(planes.h), all(planes.c), all(planes.y)};
}

}  // namespace

size_t state_floats(const ReducedNetwork& network, uint32_t node_count) {
  size_t floats = 0;
  for (uint32_t l = 0; l < layer_count(network); ++l) floats += 3 * plane_floats(network, node_count, l);
  return floats;
}

size_t scratch_floats(const ReducedNetwork& network, uint32_t node_count) {
  const Scratch sizes = scratch_of(network, node_count);
  return 2 * sizes.gates + sizes.y_next + sizes.px + sizes.tile;
}

HalfLayerState hidden_state(const ReducedNetwork& network, uint32_t node_count, uint32_t layer,
                            float* state) {
  const Planes<Half> planes = planes_of<Half>(network, node_count, layer, state);
  return {planes.h, planes.c, planes.y};
}

tissue::LayerState last_state(const ReducedNetwork& network, uint32_t node_count, float* state) {
  const Planes<float> planes = planes_of<float>(network, node_count, layer_count(network) - 1, state);
  return {planes.h, planes.c, planes.y};
}

LayerValues layer_values(const ReducedNetwork& network, uint32_t node_count, uint32_t layer, float* state) {
  const size_t count = size_t{network.floats.layers[layer].padded} * node_count;
  if (is_last(network, layer)) return values_of(planes_of<float>(network, node_count, layer, state), count);
  return values_of(planes_of<Half>(network, node_count, layer, state), count);
}

void network_step(const ReducedNetwork& network, const tissue::Graph& graph, const float* z,
                  const float* carry, float* state, float* scratch) {
  const Step step = {network, graph, z, carry, state, scratch};
  begin(step);
  for (uint32_t l = 0; l + 1 < layer_count(network); ++l) go_on(step, l);
  end(step);
}

}  // namespace sinew::baker
