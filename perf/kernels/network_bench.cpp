// network_bench.cpp  One step of Alt-ConvLSTM. Its operations are those of the matrix products alone.
#include "perf/kernels/bench_data.hpp"

namespace sinew::perf {
namespace {

void run_network(benchmark::State& state, const NetworkShape& shape,
                 pack::Precision precision = pack::Precision::kFloat32) {
  RandomNetwork network(shape);
  network.record.precision = precision;
  if (precision == pack::Precision::kInt8) network.make_int8();
  const TorusGraph graph(shape.nodes_u, shape.nodes_v);
  Floats memory(tissue::state_floats(network.view(), graph.nodes()));
  Floats scratch(tissue::scratch_floats(network.view(), graph.nodes()));
  Floats z(simd::pad_to_block(shape.inputs) * graph.nodes());
  for (uint32_t i = 0; i < graph.nodes(); ++i)
    z[simd::pad_to_block(shape.inputs) * i + i % shape.inputs] = 0.1f;
  for (auto _ : state) {
    tissue::network_step(network.view(), graph.view(), z.data(), nullptr, memory.data(), scratch.data());
    benchmark::ClobberMemory();
  }
  report(state, product_mflop(shape), simd::active_isa());
  state.counters["state_megabytes"] =
      4e-6 * static_cast<double>(tissue::state_floats(network.view(), graph.nodes()));
}

BENCHMARK_CAPTURE(run_network, paper, paper_shape())
    ->Name("alt_conv_lstm_paper")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, paper_fp16, paper_shape(), pack::Precision::kHalfStates)
    ->Name("alt_conv_lstm_fp16_paper")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, paper_int8, paper_shape(), pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_paper")
    ->Unit(benchmark::kMicrosecond);
// Few enough vertices that their states stay in L2.
BENCHMARK_CAPTURE(run_network, paper_in_cache, NetworkShape{9, {32, 64, 128, 64, 32, 3}, false, 15, 10})
    ->Name("alt_conv_lstm_paper_150_vertices")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, paper_int8_in_cache, NetworkShape{9, {32, 64, 128, 64, 32, 3}, false, 15, 10},
                  pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_paper_150_vertices")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, control_graph, control_graph_shape())
    ->Name("alt_conv_lstm_control_graph")
    ->Unit(benchmark::kMicrosecond);

// The shipped widths in every precision.
BENCHMARK_CAPTURE(run_network, creature, creature_shape(), pack::Precision::kFloat32)
    ->Name("alt_conv_lstm_creature")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, creature_fp16, creature_shape(), pack::Precision::kHalfStates)
    ->Name("alt_conv_lstm_fp16_creature")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, creature_int8, creature_shape(), pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_creature")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, wide, wide_shape(), pack::Precision::kFloat32)
    ->Name("alt_conv_lstm_wide")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, wide_fp16, wide_shape(), pack::Precision::kHalfStates)
    ->Name("alt_conv_lstm_fp16_wide")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, wide_int8, wide_shape(), pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_wide")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf
