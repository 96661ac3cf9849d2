// chain_data.hpp  Networks of chains with small random weights, and the matrix products that they are made
// of.
#pragma once
#include "pack/dense_layout.hpp"
#include "perf/kernels/bench_data.hpp"

namespace sinew::perf {

inline constexpr uint32_t kPatches = 1468, kNeighbours = 12;  // of DeepEmulator's bench

inline pack::NetworkRecord deep_emulator_record() {
  pack::NetworkRecord record{};
  record.model = pack::ModelKind::kDeepEmulator;
  record.max_channels = pack::kDeepWidest;
  return record;
}

inline pack::NetworkRecord coping_net_record(uint32_t latent, uint32_t blocks, uint32_t depth) {
  pack::NetworkRecord record{};
  record.model = pack::ModelKind::kCopingNet;
  record.max_channels = latent;
  record.blocks = blocks;
  record.depth = depth;
  return record;
}

// One chain's products, each of so many rows.
struct ChainProducts {
  uint32_t rows;
  std::vector<ProductShape> shapes;
};

inline ChainProducts products_of(const pack::DenseShape& chain, uint32_t rows) {
  ChainProducts products{rows, {{chain.inputs, chain.hidden}}};
  for (uint32_t k = 2; k < chain.layers; ++k) products.shapes.push_back({chain.hidden, chain.hidden});
  products.shapes.push_back({chain.hidden, chain.outputs});
  return products;
}

// Alpha and gamma of every vertex, beta of every neighbour.
inline std::vector<ChainProducts> deep_emulator_products() {
  const pack::NetworkRecord record = deep_emulator_record();
  return {products_of(chain_shape(record, 0), kPatches),
          products_of(chain_shape(record, 1), kPatches * kNeighbours),
          products_of(chain_shape(record, 2), kPatches)};
}

// A multiply-add counted as two.
inline double chain_mflop(const std::vector<ChainProducts>& chains) {
  double sum = 0;
  for (const ChainProducts& chain : chains) {
    for (const ProductShape& p : chain.shapes)
      sum += 2e-6 * chain.rows * static_cast<double>(p.depth * p.columns);
  }
  return sum;
}

// Without the edges' encoder, which is run once.
inline double coping_net_mflop(const pack::NetworkRecord& record, uint32_t nodes, uint32_t edges) {
  std::vector<ChainProducts> chains;
  for (uint32_t c = 0; c < chain_count(record); ++c) {
    if (c != 1) chains.push_back(products_of(chain_shape(record, c), c % 2 == 0 ? nodes : edges));
  }
  return chain_mflop(chains);
}

struct RandomChains {
  explicit RandomChains(const pack::NetworkRecord& sizes)
      : record(sizes), weights(random_floats(layout(), 0.1f)) {
    for (size_t k = 0; k < 2 * simd::kBlock; ++k) weights[end_ - k - 1] = 1;  // norms
  }
  simd::MlpJob chain(uint32_t index, float* out, float* scratch) {
    simd::MlpJob job;
    uint32_t first = 0;
    for (uint32_t c = 0; c < index; ++c) first += chain_shape(record, c).layers;
    job.layers = &layers[first];
    job.layer_count = chain_shape(record, index).layers;
    job.weights = weights.data();
    job.widest = static_cast<uint32_t>(simd::pad_to_block(record.max_channels));
    job.out = out;
    job.out_stride = job.layers[job.layer_count - 1].padded;
    job.scratch = scratch;
    return job;
  }

  pack::NetworkRecord record;
  std::vector<pack::DenseRecord> layers;

 private:
  size_t layout() {
    for (uint32_t c = 0; c < chain_count(record); ++c) {
      for (const ProductShape& p : products_of(chain_shape(record, c), 1).shapes) {
        const auto inputs = static_cast<uint32_t>(p.depth), outputs = static_cast<uint32_t>(p.columns),
                   padded = static_cast<uint32_t>(simd::pad_to_block(outputs));
        layers.push_back({inputs, outputs, padded, 0, end_, end_ + uint64_t{inputs} * padded});
        end_ += uint64_t{inputs + 1} * padded;
      }
    }
    return end_ += 2 * simd::kBlock;
  }
  size_t end_ = 0;

 public:
  Floats weights;
};

}  // namespace sinew::perf
