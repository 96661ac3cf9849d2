// guard.cpp  Looks at y, brings nodes back to their limit, and forgets what pushed them there.
#include "tissue/guard.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::tissue {
namespace {

// y of the last layer: three numbers of each row.
struct OutputRows {
  float* y;
  size_t stride;
  float* of(uint32_t node) const { return y + node * stride; }
};

OutputRows output_rows(const Network& network, uint32_t node_count, float* state) {
  const auto last = static_cast<uint32_t>(network.layers.size() - 1);
  return {layer_state(network, node_count, last, state).y, network.layers[last].padded};
}

bool all_finite(const OutputRows& rows, uint32_t node_count) {
  float sum = 0;  // of zeros, or NaN
  for (uint32_t node = 0; node < node_count; ++node) {
    const float* y = rows.of(node);
    sum += y[0] * 0 + y[1] * 0 + y[2] * 0;
  }
  return sum == 0;
}

void forget_node(const Network& network, uint32_t node_count, uint32_t node, float* state) {
  for (uint32_t l = 0; l < network.layers.size(); ++l) {
    const size_t padded = network.layers[l].padded;
    const LayerState layer = layer_state(network, node_count, l, state);
    for (float* values : {layer.h, layer.c, layer.y}) std::fill_n(values + node * padded, padded, 0.0f);
  }
}

// Length by hypot: the square of a wild displacement may overflow.
bool hold_at_limit(float limit_m, float* u) {
  const float length = std::hypot(u[0], u[1], u[2]);
  if (length <= limit_m) return false;
  const float scale = limit_m / length;
  for (int axis = 0; axis < 3; ++axis) u[axis] *= scale;
  return true;
}

}  // namespace

GuardResult guard_step(const Network& network, std::span<const pack::RegionRecord> regions,
                       uint32_t node_count, float* state, float* displacement) noexcept {
  GuardResult result;
  const OutputRows rows = output_rows(network, node_count, state);
  const float unit_m = network.record->length_unit_m;
  result.restart =
      !all_finite(rows, node_count) ||
      (std::isinf(network.record->state_clamp) && !std::isfinite(largest_cell(network, node_count, state)));
  if (result.restart) return result;
  for (const pack::RegionRecord& region : regions) {
    for (uint32_t node = region.first_node; node < region.first_node + region.node_count; ++node) {
      float* u = displacement + size_t{node} * 3;
      float* y = rows.of(node);
      for (int axis = 0; axis < 3; ++axis) u[axis] = y[axis] * unit_m;
      if (!hold_at_limit(region.displacement_limit_m, u)) continue;
      ++result.displacement_clamps;
      forget_node(network, node_count, node, state);
      for (int axis = 0; axis < 3; ++axis) y[axis] = u[axis] / unit_m;
    }
  }
  return result;
}

void rebase_state(const Network& network, uint32_t node_count, const float* displacement,
                  float* state) noexcept {
  std::fill_n(state, state_floats(network, node_count), 0.0f);
  const OutputRows rows = output_rows(network, node_count, state);
  for (uint32_t node = 0; node < node_count; ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      rows.of(node)[axis] =
          displacement[size_t{node} * 3 + static_cast<size_t>(axis)] / network.record->length_unit_m;
    }
  }
}

}  // namespace sinew::tissue
