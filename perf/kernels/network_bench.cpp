// network_bench.cpp  One step of Alt-ConvLSTM, as a share of the core's multiply-add peak measured in the
// same process.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "perf/kernels/fma_peak.hpp"
#include "simd/isa.hpp"
#include "simd/kernels.hpp"
#include "tissue/network.hpp"

namespace {

using namespace sinew;

// A 64-byte aligned array of floats.
class Floats {
 public:
  explicit Floats(size_t count) : blocks_((count + 15) / 16) {}
  float* data() { return blocks_.data()->values; }

 private:
  struct alignas(64) Block {
    float values[16] = {};
  };
  std::vector<Block> blocks_;
};

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
  tissue::Graph view() const {
    return {static_cast<uint32_t>(row_starts.size() - 1), row_starts.data(), neighbours.data(),
            values.data()};
  }
  std::vector<uint32_t> row_starts, neighbours;
  std::vector<float> values;
};

// A network of these widths with small random weights; `self` adds W_s to each layer.
struct RandomNetwork {
  RandomNetwork(uint32_t input_width, const std::vector<uint32_t>& channels, bool self)
      : weights(layout(input_width, channels, self)) {
    std::mt19937 random(1);
    for (size_t i = 0; i < weight_floats; ++i) {
      weights.data()[i] = (static_cast<float>(random()) / 4294967296.0f - 0.5f) * 0.1f;
    }
    record.model = pack::ModelKind::kAltConvLstm;
    record.layer_count = static_cast<uint32_t>(channels.size());
    record.input_width = input_width;
    for (const uint32_t width : channels) record.max_channels = std::max(record.max_channels, width);
    record.rate_hz = 60;
    record.output_scale = 1;
    record.output_leak = 0.02f;
    record.hidden_leak = 0.2f;
    record.state_clamp = 8;
    record.length_unit = 1;
  }

  tissue::Network view() { return {&record, layers, {}, weights.data()}; }

  std::vector<pack::LayerRecord> layers;
  size_t weight_floats = 0;
  double products = 0;  // multiply-adds a node and step
  pack::NetworkRecord record{};
  Floats weights;

 private:
  uint64_t take(size_t rows, size_t gates, size_t padded) {
    const size_t start = weight_floats;
    weight_floats += rows * gates * padded;
    return start;
  }
  size_t layout(uint32_t inputs, const std::vector<uint32_t>& channels, bool self) {
    for (const uint32_t width : channels) {
      const auto padded = static_cast<uint32_t>(simd::pad_to_block(width));
      pack::LayerRecord layer{};
      layer.inputs = inputs, layer.channels = width, layer.padded = padded, layer.has_self = self;
      layer.w_x = take(inputs, 4, padded);
      if (self) layer.w_s = take(inputs, 4, padded);
      layer.w_h = take(width, 4, padded);
      layer.w_y = take(width, 3, padded);
      layer.bias = take(1, 4, padded);
      layers.push_back(layer);
      products += (self ? 8.0 : 4.0) * inputs * width + 7.0 * width * width;
      inputs = width;
    }
    return weight_floats;
  }
};

void run_network(benchmark::State& state, const TorusGraph& graph, uint32_t inputs,
                 const std::vector<uint32_t>& channels, bool self) {
  RandomNetwork network(inputs, channels, self);
  const tissue::Graph view = graph.view();
  Floats memory(tissue::state_floats(network.view(), view.node_count));
  Floats scratch(tissue::scratch_floats(network.view(), view.node_count));
  Floats z(simd::pad_to_block(inputs) * view.node_count);
  for (uint32_t i = 0; i < view.node_count; ++i) z.data()[simd::pad_to_block(inputs) * i + i % inputs] = 0.1f;
  for (auto _ : state) {
    tissue::network_step(network.view(), view, z.data(), nullptr, memory.data(), scratch.data());
    benchmark::ClobberMemory();
  }
  static const double peak = perf::fma_peak_gflops();
  const double gflop = 2e-9 * network.products * view.node_count;
  state.counters["MFLOP"] = gflop * 1e3;
  state.counters["of_peak"] = benchmark::Counter(gflop / peak, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["peak_GFLOPs"] = peak;
  state.SetLabel(simd::active_isa());
}

// The paper's widths on as many vertices as its character has (6,890 = 106 x 65).
void alt_conv_lstm_paper(benchmark::State& state) {
  run_network(state, TorusGraph(106, 65), 9, {32, 64, 128, 64, 32, 3}, false);
}
BENCHMARK(alt_conv_lstm_paper)->Unit(benchmark::kMicrosecond);

// A shipped form: 34 inputs, two hidden layers of 16, on 240 control nodes.
void alt_conv_lstm_control_graph(benchmark::State& state) {
  run_network(state, TorusGraph(20, 12), 34, {16, 16, 3}, true);
}
BENCHMARK(alt_conv_lstm_control_graph)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
