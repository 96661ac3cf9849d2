// run_steps.hpp  Steps of an Alt-ConvLSTM in any precision, timed.
#pragma once
#include "perf/kernels/bench_data.hpp"

namespace sinew::perf {

// Network: tissue::Network, or what has functions of the same names.
template <class Network>
void run_steps(benchmark::State& state, const NetworkShape& shape, const Network& network) {
  const TorusGraph graph(shape.nodes_u, shape.nodes_v);
  Floats memory(state_floats(network, graph.nodes())), scratch(scratch_floats(network, graph.nodes()));
  Floats z(simd::pad_to_block(shape.inputs) * graph.nodes());
  for (uint32_t i = 0; i < graph.nodes(); ++i)
    z[simd::pad_to_block(shape.inputs) * i + i % shape.inputs] = 0.1f;
  for (auto _ : state) {
    network_step(network, graph.view(), z.data(), nullptr, memory.data(), scratch.data());
    benchmark::ClobberMemory();
  }
  report(state, product_mflop(shape), simd::active_isa());
  state.counters["state_megabytes"] = 4e-6 * static_cast<double>(state_floats(network, graph.nodes()));
}

}  // namespace sinew::perf
