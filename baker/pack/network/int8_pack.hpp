// int8_pack.hpp  Float weights to the int8 sections of a pack.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "pack/format.hpp"

namespace sinew::baker {

// The largest magnitudes that a layer heard in each channel, over all nodes and steps of a roll-out.
struct HeardRanges {
  std::vector<float> px, x;  // [inputs]
  std::vector<float> h, y;   // [channels], of P h and P y
};

struct Int8Sections {
  std::vector<int8_t> weights;
  std::vector<int32_t> sums;
  std::vector<float> scales;
};

// What a channel never exceeded becomes 127, and is clamped there; a channel that moved less than 1/16 of the
// layer's widest of its kind is given that much. Those units are then the weights', and each gate's column is
// rounded to its own largest 127th. `floats` are the tensors of the kWeights section; ranges: of each hidden
// layer. Throws BadInput: ranges of another network, negative, NaN or infinite.
Int8Sections quantize_network(std::span<const pack::LayerRecord> layers, std::span<const float> floats,
                              std::span<const HeardRanges> ranges);

}  // namespace sinew::baker
