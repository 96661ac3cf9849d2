// dense_layout.hpp  Which dense layers a network of chains has (format.hpp, DenseRecord), in what order.
#pragma once
#include <cstdint>

#include "pack/format.hpp"
#include "pack/weight_layout.hpp"

namespace sinew::pack {

inline constexpr uint32_t kMaxLatent = 256, kMaxBlocks = 16, kMaxDepth = 8;  // of a COPINGNet

// DeepEmulator: alpha, beta, gamma, of five layers each. COPINGNet: encoder, each block, decoder, of each the
// chain of nodes and the chain of edges, of depth + 1 layers.
inline constexpr uint32_t kDeepChainLayers = 5, kDeepWidest = 192, kDeepLatentStep = 16;

struct DenseShape {
  uint32_t inputs, hidden, outputs;  // of a chain
  uint32_t layers;
};

constexpr uint32_t chain_count(const NetworkRecord& record) noexcept {
  return record.model == ModelKind::kDeepEmulator ? 3 : 2 * (record.blocks + 2);
}

constexpr DenseShape chain_shape(const NetworkRecord& record, uint32_t chain) noexcept {
  if (record.model == ModelKind::kDeepEmulator) {
    const uint32_t widest = record.max_channels, width = widest / 3 * (chain + 1);
    constexpr uint32_t kInputs[] = {18, 37};
    return {chain < 2 ? kInputs[chain] : widest, width, chain < 2 ? width : 3, kDeepChainLayers};
  }
  const uint32_t latent = record.max_channels, layers = record.depth + 1;
  const bool of_edges = chain % 2 == 1;
  if (chain < 2) return {of_edges ? 5u : 14u, latent, latent, layers};
  if (chain < 2 * (record.blocks + 1)) return {(of_edges ? 3 : 2) * latent, latent, latent, layers};
  return {latent, latent, 6, layers};
}

constexpr uint32_t dense_count(const NetworkRecord& record) noexcept {
  return record.model == ModelKind::kDeepEmulator ? 3 * kDeepChainLayers
                                                  : chain_count(record) * (record.depth + 1);
}

// Where one weight is, counted from the layer's w.
constexpr uint64_t weight_at(const DenseRecord& layer, uint32_t input, uint32_t output) noexcept {
  return panel_weight_at(layer.inputs, layer.padded, input, output);
}

}  // namespace sinew::pack
