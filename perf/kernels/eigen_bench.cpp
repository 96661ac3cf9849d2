// eigen_bench.cpp  The products of a step in plain Eigen, compiled for this machine.
//
// The library's own Eigen is compiled for the baseline, and code of both kinds must not meet under one name.
#define Eigen eigen_of_this_machine
#include <Eigen/Core>

#include "perf/kernels/bench_data.hpp"

namespace sinew::perf {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void eigen_products(benchmark::State& state, const NetworkShape& shape) {
  struct LayerData {
    Matrix out;
    std::vector<Matrix> x, w;
  };
  std::vector<LayerData> layers;
  for (const LayerProducts& layer : products_of(shape)) {
    LayerData data{Matrix::Zero(shape.nodes(), 4 * layer.channels), {}, {}};
    for (const ProductShape& p : layer.shapes) {
      data.x.push_back(Matrix::Random(shape.nodes(), p.depth));
      data.w.push_back(Matrix::Random(p.depth, p.columns) * 0.05f);
    }
    layers.push_back(std::move(data));
  }
  for (auto _ : state) {
    for (LayerData& layer : layers) {
      layer.out.setZero();
      for (size_t k = 0; k < layer.x.size(); ++k)
        layer.out.leftCols(layer.w[k].cols()).noalias() += layer.x[k] * layer.w[k];
    }
    benchmark::ClobberMemory();
  }
  report(state, product_mflop(shape), Eigen::SimdInstructionSetsInUse());
}
BENCHMARK_CAPTURE(eigen_products, paper, paper_shape())
    ->Name("eigen_products_paper")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(eigen_products, control_graph, control_graph_shape())
    ->Name("eigen_products_control_graph")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf
