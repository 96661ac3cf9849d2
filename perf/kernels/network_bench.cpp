// network_bench.cpp  One step of Alt-ConvLSTM. Its operations are those of the matrix products alone.
#include "perf/kernels/run_steps.hpp"

namespace sinew::perf {
namespace {

void run_network(benchmark::State& state, const NetworkShape& shape) {
  RandomNetwork network(shape);
  run_steps(state, shape, network.view());
}

BENCHMARK_CAPTURE(run_network, paper, paper_shape())
    ->Name("alt_conv_lstm_paper")
    ->Unit(benchmark::kMicrosecond);
// Few enough vertices that their states stay in L2.
BENCHMARK_CAPTURE(run_network, paper_in_cache, NetworkShape{9, {32, 64, 128, 64, 32, 3}, false, 15, 10})
    ->Name("alt_conv_lstm_paper_150_vertices")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, control_graph, control_graph_shape())
    ->Name("alt_conv_lstm_control_graph")
    ->Unit(benchmark::kMicrosecond);

// The shipped widths.
BENCHMARK_CAPTURE(run_network, creature, creature_shape())
    ->Name("alt_conv_lstm_creature")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_network, wide, wide_shape())->Name("alt_conv_lstm_wide")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf
