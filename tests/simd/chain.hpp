// chain.hpp  A random chain of dense layers twice: packed as the kernels read it, and as plain double loops
// to compare with.
#pragma once
#include <cmath>
#include <vector>

#include "pack/dense_layout.hpp"
#include "tests/simd/test_data.hpp"

namespace sinew::test {

struct PlainDense {  // as in a weights file: w [outputs][inputs]
  uint32_t inputs = 0, outputs = 0;
  std::vector<float> w, b;
};

inline PlainDense random_dense(std::mt19937& random, uint32_t inputs, uint32_t outputs) {
  const float scale = 2 / std::sqrt(static_cast<float>(inputs));
  PlainDense layer{inputs, outputs, std::vector<float>(size_t{inputs} * outputs),
                   std::vector<float>(outputs)};
  for (float& value : layer.w) value = uniform(random, -scale, scale);
  for (float& value : layer.b) value = uniform(random, -0.5f, 0.5f);
  return layer;
}

using PlainChain = std::vector<PlainDense>;

// Layers of the widths one after the other, the first `widths[0]` the inputs.
inline PlainChain random_chain(std::mt19937& random, const std::vector<uint32_t>& widths) {
  PlainChain chain;
  for (size_t k = 0; k + 1 < widths.size(); ++k)
    chain.push_back(random_dense(random, widths[k], widths[k + 1]));
  return chain;
}

inline double pointwise(simd::Pointwise function, double x) {
  if (function == simd::Pointwise::kTanh) return std::tanh(x);
  return function == simd::Pointwise::kRelu && x < 0 ? 0 : x;
}

inline std::vector<double> plain_dense(const PlainDense& layer, const std::vector<double>& x) {
  std::vector<double> out(layer.b.begin(), layer.b.end());
  for (size_t j = 0; j < layer.outputs; ++j) {
    for (size_t k = 0; k < layer.inputs; ++k) out[j] += layer.w[j * layer.inputs + k] * x[k];
  }
  return out;
}

inline std::vector<double> plain_mlp(const PlainChain& chain, simd::Pointwise between, simd::Pointwise last,
                                     std::vector<double> x) {
  for (size_t k = 0; k < chain.size(); ++k) {
    x = plain_dense(chain[k], x);
    for (double& value : x) value = pointwise(k + 1 < chain.size() ? between : last, value);
  }
  return x;
}

// Chains after each other, laid out as pack/format.hpp has them at DenseRecord.
class PackedChains {
 public:
  explicit PackedChains(const std::vector<PlainChain>& chains) : weights_(floats_of(chains)) {
    for (const PlainChain& chain : chains) {
      for (const PlainDense& layer : chain) add(layer);
    }
  }
  const std::vector<pack::DenseRecord>& layers() const { return records_; }
  float* weights() { return weights_.data(); }
  size_t weight_count() const { return weights_.size(); }

 private:
  static size_t floats_of(const std::vector<PlainChain>& chains) {
    size_t count = 0;
    for (const PlainChain& chain : chains) {
      for (const PlainDense& layer : chain) count += simd::pad_to_block(layer.outputs) * (layer.inputs + 1);
    }
    return count;
  }
  void add(const PlainDense& layer) {
    const auto padded = static_cast<uint32_t>(simd::pad_to_block(layer.outputs));
    const pack::DenseRecord record{
        layer.inputs, layer.outputs, padded, 0, end_, end_ + uint64_t{padded} * layer.inputs};
    for (uint32_t j = 0; j < layer.outputs; ++j) {
      for (uint32_t k = 0; k < layer.inputs; ++k)
        weights_[record.w + pack::weight_at(record, k, j)] = layer.w[size_t{j} * layer.inputs + k];
      weights_[record.bias + j] = layer.b[j];
    }
    records_.push_back(record);
    end_ = record.bias + padded;
  }
  std::vector<pack::DenseRecord> records_;
  Floats weights_;
  uint64_t end_ = 0;
};

}  // namespace sinew::test
