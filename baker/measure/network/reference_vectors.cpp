// reference_vectors.cpp  What the checks of all networks share: reading reference vectors, and the error.
#include "baker/measure/network/reference_vectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {

void check_vectors(const Safetensors& vectors, const char* model) {
  const auto found = vectors.metadata.find("sinew.vectors");
  if (found == vectors.metadata.end())
    throw BadInput(vectors.path +
                   ": metadata key 'sinew.vectors' is missing; is this a file of reference vectors?");
  if (found->second != model)
    throw BadInput(vectors.path + ": vectors of '" + found->second + "', the network is of '" + model +
                   "'; check it with vectors of its own");
}

std::vector<std::pair<int, int>> read_edges(const Safetensors& vectors) {
  const std::vector<int32_t> ends = vectors.need("edges", {-1, 2}).as_i32();
  std::vector<std::pair<int, int>> edges;
  for (size_t k = 0; k < ends.size(); k += 2) edges.emplace_back(ends[k], ends[k + 1]);
  return edges;
}

void ErrorSum::add(float value, float expected) {
  double error = std::fabs(double{value} - double{expected});
  if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
  largest_ = std::max(largest_, error);
  sum_ += error;
  ++count_;
}

RollOutError ErrorSum::result(size_t steps) const {
  return {steps, largest_, sum_ / static_cast<double>(std::max<size_t>(count_, 1))};
}

AlignedFloats::AlignedFloats(size_t count)
    : block_(std::max<size_t>(count, 1) * sizeof(float)), data_(reinterpret_cast<float*>(block_.data())) {
  if (data_ == nullptr) throw std::bad_alloc();
}

}  // namespace sinew::baker
