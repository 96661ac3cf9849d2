// reference_vectors.hpp  What the checks of all networks share: reading reference vectors, and the error.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "core/aligned_block.hpp"

namespace sinew::baker {

// Throws BadInput where the file is not of vectors of this model.
void check_vectors(const Safetensors& vectors, const char* model);

// Tensor edges (m, 2).
std::vector<std::pair<int, int>> read_edges(const Safetensors& vectors);

struct RollOutError {  // over every output and, where the vectors have them, final states
  size_t steps = 0;
  double max_abs_error = 0, mean_abs_error = 0;
};

// A result that is not finite is an infinite error.
class ErrorSum {
 public:
  void add(float value, float expected);
  RollOutError result(size_t steps) const;

 private:
  double largest_ = 0, sum_ = 0;
  size_t count_ = 0;
};

// Zeroed floats on a cache line, as the kernels want them.
class AlignedFloats {
 public:
  explicit AlignedFloats(size_t count);
  float* data() { return data_; }

 private:
  core::AlignedBlock block_;
  float* data_;
};

}  // namespace sinew::baker
