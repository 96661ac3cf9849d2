// int8_layout.hpp  How much of the int8 sections (pack/format.hpp, kInt8Weights) a hidden layer takes.
#pragma once
#include <cstdint>

#include "pack/format.hpp"

namespace sinew::baker {

struct Int8Extent {
  uint32_t depth;  // of what is quantised: x, x again with W_s, h, P y, each padded to 16; the first layer's
                   // x is not
  uint64_t weights, sums, scales;  // elements
};

constexpr Int8Extent int8_extent(const pack::LayerRecord& layer, bool is_first) noexcept {
  const uint32_t p = layer.padded, x = static_cast<uint32_t>(pack::round_up_16(layer.inputs));
  const uint32_t depth = (is_first ? 0 : (1 + layer.has_self) * x) + 2 * p;
  return {depth, uint64_t{4} * p * (depth - p) + uint64_t{3} * p * p, uint64_t{5} * p,
          depth + uint64_t{5} * p};
}

}  // namespace sinew::baker
