// test_data.hpp  Seeded numbers, aligned arrays and graphs for the kernel tests.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "kernels/kernels.hpp"

namespace sinew::test {

// 64-byte aligned, as the kernels want it.
class Floats {
 public:
  explicit Floats(size_t count, float value = 0) : values_(count + 16, value), count_(count) {}
  Floats(Floats&&) = default;  // a copy could be aligned otherwise
  float* data() {
    const auto address = reinterpret_cast<uintptr_t>(values_.data());
    return values_.data() + (64 - address % 64) % 64 / sizeof(float);
  }
  float& operator[](size_t i) { return data()[i]; }
  size_t size() const { return count_; }
  std::vector<float> copy() { return {data(), data() + count_}; }

 private:
  std::vector<float> values_;
  size_t count_;
};

inline float uniform(std::mt19937& random, float low, float high) {
  // Not std::uniform_real_distribution: its values differ between libraries.
  return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
}

// The larger of two errors; one that is not a number is the largest.
inline double larger(double worst, double error) {
  if (!std::isfinite(error)) return std::numeric_limits<double>::infinity();
  return error > worst ? error : worst;
}

// [rows][stride]: `width` random numbers a row, padding zero.
inline Floats random_rows(std::mt19937& random, size_t rows, size_t width, size_t stride, float scale) {
  Floats out(rows * stride);
  for (size_t r = 0; r < rows; ++r) {
    for (size_t k = 0; k < width; ++k) out[r * stride + k] = uniform(random, -scale, scale);
  }
  return out;
}

struct TestGraph {
  std::vector<uint32_t> rows{0}, columns;
  std::vector<float> values;
  simd::SparseRows view() const { return {rows.data(), columns.data(), values.data()}; }
};

// D^-1/2 (A + I) D^-1/2 of a ring with some chords; the last node stands alone.
inline TestGraph ring_with_chords(uint32_t nodes) {
  std::vector<std::set<uint32_t>> around(nodes);
  for (uint32_t i = 0; i < nodes; ++i) around[i].insert(i);
  for (uint32_t i = 0; i + 1 < nodes; ++i) {
    for (const uint32_t other : {(i + 1) % (nodes - 1), (i * 7 + 3) % (nodes - 1)}) {
      around[i].insert(other);
      around[other].insert(i);
    }
  }
  TestGraph graph;
  for (uint32_t i = 0; i < nodes; ++i) {
    for (const uint32_t j : around[i]) {
      graph.columns.push_back(j);
      graph.values.push_back(1 / std::sqrt(static_cast<float>(around[i].size() * around[j].size())));
    }
    graph.rows.push_back(static_cast<uint32_t>(graph.columns.size()));
  }
  return graph;
}

}  // namespace sinew::test
