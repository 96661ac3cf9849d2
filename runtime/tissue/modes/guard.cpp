// guard.cpp  Looks for what is not finite, and scales what would go beyond its limit.
#include "tissue/modes/guard.hpp"

#include <algorithm>
#include <cmath>

#include "tissue/network/inputs.hpp"
#include "tissue/network/network.hpp"

namespace sinew::tissue {
namespace {

// y of the last layer: three numbers of each row.
struct OutputRows {
  float* y;
  size_t stride;
  float* of(uint32_t node) const { return y + node * stride; }
};

OutputRows output_rows(const Network& network, uint32_t node_count, const float* state) {
  const auto last = static_cast<uint32_t>(network.layers.size() - 1);
  return {layer_state(network, node_count, last, const_cast<float*>(state)).y, network.layers[last].padded};
}

void write_node(const OutputRows& rows, uint32_t node, float unit_m, const float* l) {
  for (int axis = 0; axis < 3; ++axis) rows.of(node)[axis] = l[axis] / unit_m;
}

}  // namespace

bool all_finite(const float* values, size_t count) noexcept {
  float sum = 0;  // of zeros, or NaN
  for (size_t i = 0; i < count; ++i) sum += values[i] * 0;
  return sum == 0;
}

bool network_is_finite(const Network& network, uint32_t node_count, const float* state) noexcept {
  const OutputRows rows = output_rows(network, node_count, state);
  for (uint32_t node = 0; node < node_count; ++node) {
    if (!all_finite(rows.of(node), 3)) return false;
  }
  return !std::isinf(network.record->state_clamp) || std::isfinite(largest_cell(network, node_count, state));
}

float limit_share(float largest_m, float limit_m) noexcept {
  const float free_m = kFreeShare * limit_m, rest_m = limit_m - free_m;
  if (!(largest_m > free_m)) return 1;
  return (free_m + rest_m * std::tanh((largest_m - free_m) / rest_m)) / largest_m;
}

float swing_share(float largest_m, float limit_m) noexcept {
  return limit_share(largest_m, limit_m / kFreeShare);
}

float largest_displacement_m(const float* l, uint32_t nodes) noexcept {
  float largest_m = 0;
  for (uint32_t i = 0; i < nodes; ++i, l += 3) largest_m = std::max(largest_m, std::hypot(l[0], l[1], l[2]));
  return largest_m;
}

void show(float share, uint32_t nodes, float* u) noexcept {
  for (size_t i = 0; share != 1 && i < size_t{3} * nodes; ++i) u[i] *= share;
}

void hold_within(float limit_m, uint32_t nodes, float* u) noexcept {
  show(limit_share(largest_displacement_m(u, nodes), limit_m), nodes, u);
}

void read_output(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                 const float* state, float* l) noexcept {
  const OutputRows rows = output_rows(network, node_count, state);
  for (const pack::RegionRecord& region : regions) {
    const float unit_m = length_unit_m(network, region);
    for (uint32_t node = region.first_node; node < region.first_node + region.node_count; ++node) {
      for (int axis = 0; axis < 3; ++axis) *l++ = rows.of(node)[axis] * unit_m;
    }
  }
}

void write_output(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                  const float* l, float* state) noexcept {
  if (network.layers.empty()) return;
  const OutputRows rows = output_rows(network, node_count, state);
  for (const pack::RegionRecord& region : regions) {
    const float share =
        limit_share(largest_displacement_m(l, region.node_count), region.displacement_limit_m);
    const float unit_m = length_unit_m(network, region) / share;
    for (uint32_t node = region.first_node; node < region.first_node + region.node_count; ++node, l += 3)
      write_node(rows, node, unit_m, l);
  }
}

void carry_to(const Network& network, const pack::RegionRecord& region, uint32_t node_count, const float* l,
              const float* state, float* carry) noexcept {
  const OutputRows rows = output_rows(network, node_count, state);
  const float unit_m = length_unit_m(network, region);
  for (uint32_t node = region.first_node; node < region.first_node + region.node_count; ++node) {
    for (int axis = 0; axis < 3; ++axis) *carry++ = *l++ / unit_m - rows.of(node)[axis];
  }
}

void rebase_state(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                  const float* l, float* state) noexcept {
  std::fill_n(state, state_floats(network, node_count), 0.0f);
  write_output(network, regions, node_count, l, state);
}

}  // namespace sinew::tissue
