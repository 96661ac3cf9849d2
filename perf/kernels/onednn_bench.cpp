// onednn_bench.cpp  oneDNN's matrix products alone, on the shapes of a step: no aggregation, no activations,
// no states. What the whole step is compared with.
#include <oneapi/dnnl/dnnl.h>

#include "perf/kernels/chain_data.hpp"

namespace sinew::perf {
namespace {

int64_t widest_input(const NetworkShape& shape) {
  int64_t widest = 0;
  for (const LayerProducts& layer : products_of(shape)) {
    for (const ProductShape& p : layer.shapes) widest = std::max(widest, p.depth);
  }
  return widest;
}

int64_t weight_count(const NetworkShape& shape) {
  int64_t count = 0;
  for (const LayerProducts& layer : products_of(shape)) {
    for (const ProductShape& p : layer.shapes) count += p.depth * p.columns;
  }
  return count;
}

// multiply(product, row-major weights, row length of out, first of a layer) for each product of a step.
template <class Multiply>
void for_every_product(const NetworkShape& shape, const Multiply& multiply) {
  int64_t at = 0;
  for (const LayerProducts& layer : products_of(shape)) {
    for (size_t k = 0; k < layer.shapes.size(); ++k) {
      multiply(layer.shapes[k], at, 4 * layer.channels, k == 0);
      at += layer.shapes[k].depth * layer.shapes[k].columns;
    }
  }
}

void onednn_sgemm(benchmark::State& state, const NetworkShape& shape) {
  const int64_t nodes = shape.nodes(), widest = widest_input(shape);
  Floats x = random_floats(static_cast<size_t>(nodes * widest), 1);
  Floats w = random_floats(static_cast<size_t>(weight_count(shape)), 0.05f);
  Floats out(static_cast<size_t>(nodes * 4 * widest));
  for (auto _ : state) {
    for_every_product(shape, [&](const ProductShape& p, int64_t at, int64_t row, bool first) {
      dnnl_sgemm('N', 'N', nodes, p.columns, p.depth, 1, x.data(), p.depth, w.data() + at, p.columns,
                 first ? 0.0f : 1.0f, out.data(), row);
    });
    benchmark::ClobberMemory();
  }
  report(state, product_mflop(shape), "oneDNN");
}

// The products of each chain, layer after layer: what deep_emulator_chains and deep_emulator_step are
// compared with.
void onednn_sgemm_chains(benchmark::State& state, const std::vector<ChainProducts>& chains) {
  constexpr size_t kRows = size_t{kPatches} * kNeighbours, kWidest = pack::kDeepWidest;
  Floats x = random_floats(kRows * kWidest, 1), w = random_floats(kWidest * kWidest * 15, 0.1f),
         even(kRows * kWidest), odd(kRows * kWidest);
  for (auto _ : state) {
    const float* next = w.data();
    for (const ChainProducts& chain : chains) {
      const float* from = x.data();
      float *to = even.data(), *other = odd.data();
      for (const ProductShape& p : chain.shapes) {
        dnnl_sgemm('N', 'N', chain.rows, p.columns, p.depth, 1, from, p.depth, next, p.columns, 0, to,
                   p.columns);
        next += p.depth * p.columns;
        from = to;
        std::swap(to, other);
      }
    }
    benchmark::ClobberMemory();
  }
  report(state, chain_mflop(chains), "oneDNN");
}

void onednn_u8s8s32(benchmark::State& state, const NetworkShape& shape) {
  const int64_t nodes = shape.nodes(), widest = widest_input(shape);
  Aligned<uint8_t> x(static_cast<size_t>(nodes * widest));
  Aligned<int8_t> w(static_cast<size_t>(weight_count(shape)));
  for (int64_t i = 0; i < nodes * widest; ++i) x[static_cast<size_t>(i)] = static_cast<uint8_t>(i % 251);
  for (int64_t i = 0; i < weight_count(shape); ++i)
    w[static_cast<size_t>(i)] = static_cast<int8_t>(i % 127 - 63);
  Aligned<int32_t> out(static_cast<size_t>(nodes * 4 * widest));
  const int32_t zero = 0;
  for (auto _ : state) {
    for_every_product(shape, [&](const ProductShape& p, int64_t at, int64_t row, bool first) {
      dnnl_gemm_u8s8s32('N', 'N', 'F', nodes, p.columns, p.depth, 1, x.data(), p.depth, 0, w.data() + at,
                        p.columns, 0, first ? 0.0f : 1.0f, out.data(), row, &zero);
    });
    benchmark::ClobberMemory();
  }
  report(state, product_mflop(shape), "oneDNN");
}

BENCHMARK_CAPTURE(onednn_sgemm, paper, paper_shape())
    ->Name("onednn_sgemm_paper")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(onednn_sgemm, control_graph, control_graph_shape())
    ->Name("onednn_sgemm_control_graph")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(onednn_u8s8s32, paper, paper_shape())
    ->Name("onednn_u8s8s32_paper")
    ->Unit(benchmark::kMicrosecond);

BENCHMARK_CAPTURE(onednn_sgemm_chains, deep_emulator, deep_emulator_products())
    ->Name("onednn_sgemm_deep_emulator")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf
