// reference_network.hpp  A random Alt-ConvLSTM twice: packed as the runtime reads it, and as plain double
// loops to compare with.
#pragma once
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "pack/weight_layout.hpp"
#include "tests/simd/test_data.hpp"
#include "tissue/network/narrow_layer.hpp"
#include "tissue/network/network.hpp"

namespace sinew::test {

struct PlainLayer {  // rows of gates x channels, as in a weights file
  size_t inputs = 0, channels = 0;
  std::vector<float> w_x, w_s, w_h, w_y, b;
};

struct PlainState {  // [nodes][channels]
  std::vector<double> h, c, y;
};

inline std::vector<float> random_floats(std::mt19937& random, size_t count, float scale) {
  std::vector<float> out(count);
  for (float& value : out) value = uniform(random, -scale, scale);
  return out;
}

inline PlainLayer random_layer(std::mt19937& random, size_t inputs, size_t channels, bool has_self) {
  const float scale = 2 / std::sqrt(static_cast<float>(inputs + 2 * channels));
  return {inputs,
          channels,
          random_floats(random, inputs * 4 * channels, scale),
          random_floats(random, has_self ? inputs * 4 * channels : 0, scale),
          random_floats(random, channels * 4 * channels, scale),
          random_floats(random, channels * 3 * channels, scale),
          random_floats(random, 4 * channels, 0.5f)};
}

// The packed form; keeps what tissue::Network points to.
class PackedNetwork {
 public:
  PackedNetwork(const pack::NetworkRecord& record, const std::vector<PlainLayer>& layers)
      : record_(record), weights_(packed_floats(layers)) {
    for (const PlainLayer& layer : layers) add_layer(layer);
    record_.layer_count = static_cast<uint32_t>(layers.size());
    record_.input_width = static_cast<uint32_t>(layers.front().inputs);
    narrow_ = std::make_unique<Floats>(tissue::narrow_floats(view()));
    tissue::pack_narrow(view(), narrow_->data());
  }
  tissue::Network view() {
    return {&record_, records_, inputs, weights_.data(), narrow_ ? narrow_->data() : nullptr};
  }
  pack::NetworkRecord& record() { return record_; }
  std::vector<pack::InputRecord> inputs;

 private:
  static size_t packed_floats(const std::vector<PlainLayer>& layers) {
    size_t count = 0;
    for (const PlainLayer& layer : layers) {
      count += simd::pad_to_block(layer.channels) * (8 * layer.inputs + 7 * layer.channels + 4);
    }
    return count;
  }
  // place(row, gate, channel) of plain [rows][gates][channels].
  template <class Place>
  uint64_t add_tensor(const std::vector<float>& plain, const pack::LayerRecord& layer, size_t gates,
                      const Place& place) {
    const uint64_t start = end_;
    const size_t rows = plain.size() / layer.channels / gates;
    for (size_t i = 0; i < plain.size(); ++i) {
      const size_t j = i % layer.channels, gate = i / layer.channels % gates;
      weights_[start + place(i / layer.channels / gates, gate, j)] = plain[i];
    }
    end_ += rows * gates * layer.padded;
    return start;
  }
  uint64_t add_gates(const std::vector<float>& plain, const pack::LayerRecord& layer) {
    const size_t rows = plain.size() / layer.channels / 4;
    return add_tensor(plain, layer, 4, [=](size_t row, size_t gate, size_t j) {
      return pack::gate_weight_at(rows, 4, row, gate, j);
    });
  }
  void add_layer(const PlainLayer& layer) {
    pack::LayerRecord record{};
    record.inputs = static_cast<uint32_t>(layer.inputs);
    record.channels = static_cast<uint32_t>(layer.channels);
    record.padded = static_cast<uint32_t>(simd::pad_to_block(layer.channels));
    record.has_self = !layer.w_s.empty();
    record.w_x = add_gates(layer.w_x, record);
    record.w_s = add_gates(layer.w_s, record);
    record.w_h = add_gates(layer.w_h, record);
    record.w_y = add_tensor(layer.w_y, record, 3, [&](size_t row, size_t gate, size_t j) {
      return pack::peephole_at(record, row, gate, j);
    });
    record.bias = add_tensor(layer.b, record, 4,
                             [&](size_t, size_t gate, size_t j) { return gate * record.padded + j; });
    records_.push_back(record);
  }
  pack::NetworkRecord record_;
  std::vector<pack::LayerRecord> records_;
  Floats weights_;
  std::unique_ptr<Floats> narrow_;
  size_t end_ = 0;
};

using Rows = std::vector<double>;  // [nodes][width]

inline Rows aggregated(const TestGraph& graph, const Rows& x, size_t width) {
  Rows out(x.size(), 0.0);
  for (size_t i = 0; i + 1 < graph.rows.size(); ++i) {
    for (uint32_t e = graph.rows[i]; e < graph.rows[i + 1]; ++e) {
      for (size_t k = 0; k < width; ++k)
        out[i * width + k] += double{graph.values[e]} * x[graph.columns[e] * width + k];
    }
  }
  return out;
}

// x W of one node and one column.
inline double dot(const Rows& x, size_t node, size_t width, const std::vector<float>& w, size_t columns,
                  size_t column) {
  double sum = 0;
  for (size_t k = 0; k < width; ++k) sum += x[node * width + k] * w[k * columns + column];
  return sum;
}

inline double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

// pack/format.hpp, NetworkRecord, word for word. Returns c, the next layer's x.
inline Rows reference_layer(const PlainLayer& layer, const TestGraph& graph,
                            const pack::NetworkRecord& record, bool is_last, const Rows& x,
                            const float* carry, PlainState* s) {
  const size_t nodes = graph.rows.size() - 1, f = layer.channels;
  const Rows px = aggregated(graph, x, layer.inputs), ph = aggregated(graph, s->h, f),
             py = aggregated(graph, s->y, f);
  const auto gate = [&](size_t node, size_t g, size_t j) {
    const size_t at = g * f + j;
    const double self = layer.w_s.empty() ? 0 : dot(x, node, layer.inputs, layer.w_s, 4 * f, at);
    return dot(px, node, layer.inputs, layer.w_x, 4 * f, at) + self + dot(ph, node, f, layer.w_h, 4 * f, at) +
           layer.b[at];
  };
  Rows o(nodes * f);
  for (size_t n = 0; n < nodes; ++n) {
    for (size_t j = 0; j < f; ++j) {
      const double i = sigmoid(gate(n, 0, j) + dot(py, n, f, layer.w_y, 3 * f, j));
      const double forget = sigmoid(gate(n, 1, j) + dot(py, n, f, layer.w_y, 3 * f, f + j));
      double& c = s->c[n * f + j];
      double& y = s->y[n * f + j];
      c = forget * c + i * std::tanh(gate(n, 2, j));
      c = std::fmin(std::fmax(c, -double{record.state_clamp}), double{record.state_clamp});
      o[n * f + j] = gate(n, 3, j);
      y = is_last ? (1 - double{record.output_leak}) * y + double{record.output_scale} * c
                  : (1 - double{record.hidden_leak}) * y + c;
      if (is_last && carry) y += carry[n * 3 + j];
    }
  }
  const Rows py_now = aggregated(graph, s->y, f);
  for (size_t n = 0; n < nodes; ++n) {
    for (size_t j = 0; j < f; ++j) {
      const double gate_o = sigmoid(o[n * f + j] + dot(py_now, n, f, layer.w_y, 3 * f, 2 * f + j));
      s->h[n * f + j] = gate_o * std::tanh(s->c[n * f + j]);
    }
  }
  return s->c;
}

inline void reference_step(const std::vector<PlainLayer>& layers, const TestGraph& graph,
                           const pack::NetworkRecord& record, Rows x, const float* carry,
                           std::vector<PlainState>* states) {
  for (size_t l = 0; l < layers.size(); ++l) {
    x = reference_layer(layers[l], graph, record, l + 1 == layers.size(), x, carry, &(*states)[l]);
  }
}

// The paper's wiring, to be changed by a test.
inline pack::NetworkRecord plain_record() {
  pack::NetworkRecord record{};
  record.model = pack::ModelKind::kAltConvLstm;
  record.rate_hz = 60;
  record.output_scale = 1;
  record.state_clamp = std::numeric_limits<float>::infinity();
  record.length_unit = 1;
  return record;
}

}  // namespace sinew::test
