// weight_layout.hpp  Where a weight lies in its tensor (format.hpp, LayerRecord and DenseRecord): in the
// order that kernels read.
#pragma once
#include <algorithm>
#include <cstdint>

#include "pack/format.hpp"

namespace sinew::pack {

// In [padded / 16][rows][gates][16].
constexpr uint64_t gate_weight_at(uint64_t rows, uint64_t gates, uint64_t row, uint64_t gate,
                                  uint64_t channel) noexcept {
  return ((channel / 16 * rows + row) * gates + gate) * 16 + channel % 16;
}

// In [padded / kPanel][rows][kPanel], the last panel as wide as what is left.
constexpr uint64_t panel_weight_at(uint64_t rows, uint64_t padded, uint64_t row, uint64_t column) noexcept {
  const uint64_t panel = column / kPanel * kPanel, width = std::min<uint64_t>(kPanel, padded - panel);
  return panel * rows + row * width + column - panel;
}

// In W_y: gates i and f, then gate o by panels.
constexpr uint64_t peephole_at(const LayerRecord& layer, uint64_t row, uint64_t gate,
                               uint64_t channel) noexcept {
  const uint64_t rows = layer.channels, output = 2 * rows * layer.padded;
  return gate < 2 ? gate_weight_at(rows, 2, row, gate, channel)
                  : output + panel_weight_at(rows, layer.padded, row, channel);
}

}  // namespace sinew::pack
