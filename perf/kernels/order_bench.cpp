// order_bench.cpp  The paper's network and one aggregation on 6,890 vertices in three orders: along the
// surface's rows, shuffled, and shuffled and put in order by the baker.
#include <algorithm>
#include <numeric>

#include "baker/mesh/graph/node_order.hpp"
#include "perf/kernels/bench_data.hpp"

namespace sinew::perf {
namespace {

enum class Order { kRows, kShuffled, kByNeighbours };

std::vector<int> shuffled(size_t count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(1);
  for (size_t k = count; k > 1; --k) std::swap(order[k - 1], order[random() % k]);
  return order;
}

// order[k]: the node that comes k-th.
TorusGraph reordered(const TorusGraph& from, const std::vector<int>& order) {
  std::vector<uint32_t> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) place[static_cast<size_t>(order[k])] = static_cast<uint32_t>(k);
  TorusGraph to = from;
  for (size_t k = 0; k < order.size(); ++k) {
    const uint32_t row = from.row_starts[static_cast<size_t>(order[k])];  // seven a row
    for (uint32_t e = 0; e < 7; ++e) to.neighbours[7 * k + e] = place[from.neighbours[row + e]];
    std::ranges::sort(to.neighbours.begin() + static_cast<std::ptrdiff_t>(7 * k),
                      to.neighbours.begin() + static_cast<std::ptrdiff_t>(7 * k + 7));
  }
  return to;
}

std::vector<int> baker_order(const TorusGraph& graph) {
  std::vector<std::pair<int, int>> edges;
  for (uint32_t node = 0; node < graph.nodes(); ++node) {
    for (uint32_t e = graph.row_starts[node]; e < graph.row_starts[node + 1]; ++e) {
      if (node < graph.neighbours[e])
        edges.emplace_back(static_cast<int>(node), static_cast<int>(graph.neighbours[e]));
    }
  }
  return baker::order_by_neighbours(graph.nodes(), edges);
}

TorusGraph graph_in(Order order) {
  const NetworkShape shape = paper_shape();
  const TorusGraph rows(shape.nodes_u, shape.nodes_v);
  if (order == Order::kRows) return rows;
  const TorusGraph mixed = reordered(rows, shuffled(rows.nodes()));
  return order == Order::kShuffled ? mixed : reordered(mixed, baker_order(mixed));
}

void run_step(benchmark::State& state, Order order) {
  const NetworkShape shape = paper_shape();
  RandomNetwork network(shape);
  const TorusGraph graph = graph_in(order);
  Floats memory(tissue::state_floats(network.view(), graph.nodes()));
  Floats scratch(tissue::scratch_floats(network.view(), graph.nodes()));
  Floats z = random_floats(simd::pad_to_block(shape.inputs) * graph.nodes(), 0.1f);
  for (auto _ : state) {
    tissue::network_step(network.view(), graph.view(), z.data(), nullptr, memory.data(), scratch.data());
    benchmark::ClobberMemory();
  }
  report(state, product_mflop(shape), simd::active_isa());
}

// P x of 128 channels, a range of nodes at a time.
void run_aggregation(benchmark::State& state, Order order) {
  constexpr size_t kStride = 128;
  const TorusGraph graph = graph_in(order);
  Floats x = random_floats(kStride * graph.nodes(), 1), out(kStride * simd::kRangeNodes);
  const tissue::Graph rows = graph.view();
  for (auto _ : state) {
    for (uint32_t first = 0; first < graph.nodes(); first += simd::kRangeNodes) {
      const uint32_t last = std::min(first + simd::kRangeNodes, graph.nodes());
      simd::kernels().aggregate({rows.rows, rows.columns, rows.values}, x.data(), kStride, first, last,
                                out.data());
    }
    benchmark::ClobberMemory();
  }
  report(state, 2e-6 * 7 * kStride * graph.nodes(), simd::active_isa());
}

BENCHMARK_CAPTURE(run_step, rows, Order::kRows)
    ->Name("alt_conv_lstm_paper_rows")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_step, shuffled, Order::kShuffled)
    ->Name("alt_conv_lstm_paper_shuffled")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_step, by_neighbours, Order::kByNeighbours)
    ->Name("alt_conv_lstm_paper_reordered")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_aggregation, rows, Order::kRows)
    ->Name("aggregate_128_rows")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_aggregation, shuffled, Order::kShuffled)
    ->Name("aggregate_128_shuffled")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_aggregation, by_neighbours, Order::kByNeighbours)
    ->Name("aggregate_128_reordered")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf
