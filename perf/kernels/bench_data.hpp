// bench_data.hpp  Arrays, graphs and networks that the benches share, and how they report.
#pragma once
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "kernels/isa.hpp"
#include "kernels/kernels.hpp"
#include "tissue/network/narrow_layer.hpp"
#include "tissue/network/network.hpp"

namespace sinew::perf {

// 64-byte aligned.
template <class T>
class Aligned {
 public:
  explicit Aligned(size_t count) : blocks_((count * sizeof(T) + 63) / 64) {}
  T* data() { return reinterpret_cast<T*>(blocks_.data()); }
  T& operator[](size_t i) { return data()[i]; }

 private:
  struct alignas(64) Block {
    std::byte bytes[64] = {};
  };
  std::vector<Block> blocks_;
};
using Floats = Aligned<float>;

inline Floats random_floats(size_t count, float scale) {
  Floats out(count);
  std::mt19937 random(static_cast<uint32_t>(count));
  for (size_t i = 0; i < count; ++i) out[i] = (static_cast<float>(random()) * 0x1p-32f - 0.5f) * 2 * scale;
  return out;
}

// A closed surface of columns x rows nodes, each with six neighbours, as P = D^-1/2 (A + I) D^-1/2.
struct TorusGraph {
  TorusGraph(uint32_t columns, uint32_t rows) {
    const int steps[7][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {-1, 0}, {0, -1}, {-1, -1}};
    row_starts.push_back(0);
    for (uint32_t y = 0; y < rows; ++y) {
      for (uint32_t x = 0; x < columns; ++x) {
        for (const auto& step : steps) {
          const uint32_t u = (x + columns + static_cast<uint32_t>(step[0])) % columns;
          const uint32_t v = (y + rows + static_cast<uint32_t>(step[1])) % rows;
          neighbours.push_back(v * columns + u);
          values.push_back(1.0f / 7);
        }
        row_starts.push_back(static_cast<uint32_t>(neighbours.size()));
      }
    }
  }
  uint32_t nodes() const { return static_cast<uint32_t>(row_starts.size() - 1); }
  tissue::Graph view() const { return {nodes(), row_starts.data(), neighbours.data(), values.data()}; }
  std::vector<uint32_t> row_starts, neighbours;
  std::vector<float> values;
};

// What a network is, without its numbers.
struct NetworkShape {
  uint32_t inputs;
  std::vector<uint32_t> channels;
  bool self;                  // W_s in each layer
  uint32_t nodes_u, nodes_v;  // of the torus
  uint32_t nodes() const { return nodes_u * nodes_v; }
};

// The paper's widths on as many vertices as its character has (6,890).
inline NetworkShape paper_shape() { return {9, {32, 64, 128, 64, 32, 3}, false, 106, 65}; }
// A form like the shipped ones on 240 control nodes.
inline NetworkShape control_graph_shape() { return {34, {16, 16, 3}, true, 20, 12}; }

// The shipped networks' on as many: narrow layers, and so wide an input that it is most of their products.
inline NetworkShape creature_shape() { return {56, {8, 3}, true, 20, 12}; }
inline NetworkShape wide_shape() { return {56, {16, 3}, true, 20, 12}; }

// One matrix product of a step: [nodes x depth] [depth x columns].
struct ProductShape {
  int64_t depth, columns;
};
struct LayerProducts {
  int64_t channels;
  std::vector<ProductShape> shapes;  // x (and x again with W_s), h, y for i and f, y for o
};

inline std::vector<LayerProducts> products_of(const NetworkShape& shape) {
  std::vector<LayerProducts> layers;
  int64_t inputs = shape.inputs;
  for (const int64_t f : shape.channels) {
    LayerProducts layer{f, {{inputs, 4 * f}, {f, 4 * f}, {f, 2 * f}, {f, f}}};
    if (shape.self) layer.shapes.insert(layer.shapes.begin(), {inputs, 4 * f});
    layers.push_back(layer);
    inputs = f;
  }
  return layers;
}

// Of all products of a step, a multiply-add counted as two.
inline double product_mflop(const NetworkShape& shape) {
  double sum = 0;
  for (const LayerProducts& layer : products_of(shape)) {
    for (const ProductShape& p : layer.shapes) sum += static_cast<double>(p.depth * p.columns);
  }
  return 2e-6 * sum * shape.nodes();
}

// A network of this shape with small random weights.
struct RandomNetwork {
  explicit RandomNetwork(const NetworkShape& shape)
      : weights(random_floats(layout(shape), 0.05f)), narrow(0) {
    record.model = pack::ModelKind::kAltConvLstm;
    record.layer_count = static_cast<uint32_t>(shape.channels.size());
    record.input_width = shape.inputs;
    for (const uint32_t width : shape.channels) record.max_channels = std::max(record.max_channels, width);
    record.rate_hz = 60;
    record.output_scale = 1;
    record.output_leak = 0.02f;
    record.hidden_leak = 0.2f;
    record.state_clamp = 8;
    record.length_unit = 1;
    narrow = Floats(tissue::narrow_floats(view()));
    tissue::pack_narrow(view(), narrow.data());
  }
  tissue::Network view() { return {&record, layers, {}, weights.data(), narrow.data()}; }

  std::vector<pack::LayerRecord> layers;
  pack::NetworkRecord record{};
  Floats weights, narrow;

 private:
  size_t layout(const NetworkShape& shape) {
    size_t end = 0;
    uint32_t inputs = shape.inputs;
    for (const uint32_t width : shape.channels) {
      const auto padded = static_cast<uint32_t>(simd::pad_to_block(width));
      const auto take = [&](size_t rows, size_t gates) {
        return std::exchange(end, end + rows * gates * padded);
      };
      pack::LayerRecord layer{};
      layer.inputs = inputs, layer.channels = width, layer.padded = padded, layer.has_self = shape.self;
      layer.w_x = take(inputs, 4);
      if (shape.self) layer.w_s = take(inputs, 4);
      layer.w_h = take(width, 4);
      layer.w_y = take(width, 3);
      layer.bias = take(1, 4);
      layers.push_back(layer);
      inputs = width;
    }
    return end;
  }
};

// `mega` operations an iteration: MFLOP, or million integer operations where `unit` says so.
inline void report(benchmark::State& state, double mega, const char* label) {
  state.counters["mega_operations"] = mega;
  state.SetLabel(label);
}

}  // namespace sinew::perf
