// guard.cpp  Looks for what is not finite, brings nodes back to their limit, and forgets what pushed them
// there.
#include "tissue/guard.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tissue/inputs.hpp"

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

template <class Planes>
void forget_row(const Planes& layer, uint32_t node, size_t padded) {
  for (auto* values : {layer.h, layer.c, layer.y})
    std::memset(values + node * padded, 0, padded * sizeof *values);
}

void forget_node(const NodeMemory& memory, uint32_t node) {
  const Network& network = *memory.network;
  for (uint32_t l = 0; l < network.layers.size(); ++l) {
    const size_t padded = network.layers[l].padded;
    if (keeps_halves(network, l))
      forget_row(half_layer_state(network, memory.node_count, l, memory.state), node, padded);
    else
      forget_row(layer_state(network, memory.node_count, l, memory.state), node, padded);
  }
}

// Length by hypot: the square of a wild displacement may overflow.
bool scale_to(float limit_m, float* l) {
  const float length = std::hypot(l[0], l[1], l[2]);
  if (length <= limit_m) return false;
  const float scale = limit_m / length;
  for (int axis = 0; axis < 3; ++axis) l[axis] *= scale;
  return true;
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

uint32_t hold_at_limit(const pack::RegionRecord& region, const NodeMemory& memory, float* l,
                       float* l_before) noexcept {
  uint32_t held = 0;
  for (uint32_t i = 0; i < region.node_count; ++i, l += 3, l_before += 3) {
    if (!scale_to(region.displacement_limit_m, l)) continue;
    ++held;
    std::copy_n(l, 3, l_before);
    if (memory.network == nullptr) continue;
    const uint32_t node = region.first_node + i;
    forget_node(memory, node);
    write_node(output_rows(*memory.network, memory.node_count, memory.state), node,
               length_unit_m(*memory.network, region), l);
  }
  return held;
}

uint32_t hold_base_at_limit(const pack::RegionRecord& region, uint32_t modes, float* l, const TwoTicks& q,
                            const TwoTicks& r) noexcept {
  const uint32_t floats = 3 * region.node_count;
  uint32_t beyond = 0;
  float largest_m = 0;
  for (uint32_t i = 0; i < floats; i += 3) {
    const float length = std::hypot(l[i], l[i + 1], l[i + 2]);
    beyond += length > region.displacement_limit_m;
    largest_m = std::max(largest_m, length);
  }
  if (beyond == 0) return 0;
  const float scale = region.displacement_limit_m / largest_m;
  for (uint32_t i = 0; i < floats; ++i) l[i] *= scale;
  for (uint32_t i = 0; i < floats; ++i) r.before[i] = r.now[i] *= scale;
  for (uint32_t k = 0; k < modes; ++k) q.before[k] = q.now[k] *= scale;
  return beyond;
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
  const OutputRows rows = output_rows(network, node_count, state);
  for (const pack::RegionRecord& region : regions) {
    const float unit_m = length_unit_m(network, region);
    for (uint32_t node = region.first_node; node < region.first_node + region.node_count; ++node, l += 3)
      write_node(rows, node, unit_m, l);
  }
}

void rebase_state(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                  const float* l, float* state) noexcept {
  std::fill_n(state, state_floats(network, node_count), 0.0f);
  write_output(network, regions, node_count, l, state);
}

}  // namespace sinew::tissue
