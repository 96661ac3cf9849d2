// check_dense.cpp  A network of chains: its record, its dense layers and their weights agree with each other.

#include "core/status.hpp"
#include "pack/checks/checks.hpp"
#include "pack/dense_layout.hpp"

namespace sinew::pack {
namespace {

constexpr uint32_t kNorms = 2, kNormNumbers = 6, kNormPadded = 16;

bool is_coping_net(const ChainsView& chains) noexcept {
  return chains.record->model == ModelKind::kCopingNet;
}

Status check_precision(const NetworkRecord& record) noexcept {
  if (record.precision == Precision::kFloat32) return {};
  return core::make_status(StatusCode::kUnsupported,
                           "pack: network precision %u of a model %s, which this build runs in fp32 only; "
                           "bake it with --precision fp32",
                           static_cast<uint32_t>(record.precision),
                           kModelNames[static_cast<uint32_t>(record.model)]);
}

Status check_coping_sizes(const NetworkRecord& record) noexcept {
  if (record.max_channels < 1 || record.max_channels > kMaxLatent)
    return corrupt("network: latent width %u is outside 1..%u", record.max_channels, kMaxLatent);
  if (record.blocks < 1 || record.blocks > kMaxBlocks)
    return corrupt("network: %u blocks, outside 1..%u", record.blocks, kMaxBlocks);
  if (record.depth < 1 || record.depth > kMaxDepth)
    return corrupt("network: depth %u is outside 1..%u", record.depth, kMaxDepth);
  if (record.moving != 0) return corrupt("network: a moving frame, which a coping_net has not");
  return record.rate_hz == 0 ? Status{} : corrupt("network: a rate, which a coping_net has not");
}

Status check_deep_sizes(const NetworkRecord& record) noexcept {
  if (record.blocks != 0 || record.depth != 0)
    return corrupt("network: blocks or depth, which a deep_emulator has not");
  if (record.max_channels == 0 || record.max_channels % (3 * kDeepLatentStep) != 0 ||
      record.max_channels > kDeepWidest)
    return corrupt("network: widest layer %u, of a deep_emulator 48, 96, 144 or 192", record.max_channels);
  if (record.moving > 1) return corrupt("network: moving is neither 0 nor 1");
  return is_within(record.rate_hz, kSlowest_hz, kFastest_hz)
             ? Status{}
             : corrupt("network: rate %g Hz, outside 0.1..1e4", double{record.rate_hz});
}

Status check_record(const ChainsView& chains) noexcept {
  const NetworkRecord& record = *chains.record;
  if (Status status = check_precision(record); !status.ok()) return status;
  const bool empty = record.input_width == 0 && record.output_scale == 0 && record.output_leak == 0 &&
                     record.hidden_leak == 0 && record.state_clamp == 0 && record.length_unit == 0;
  if (!empty) return corrupt("network: fields of an alt_conv_lstm in another model");
  const Status status = is_coping_net(chains) ? check_coping_sizes(record) : check_deep_sizes(record);
  if (!status.ok()) return status;
  if (record.layer_count != chains.layers.size() || record.layer_count != dense_count(record))
    return corrupt("network: %u dense layers stated, %zu there, %u wanted", record.layer_count,
                   chains.layers.size(), dense_count(record));
  return check_zero(record.reserved, "network", 0);
}

Status check_shape(const DenseRecord& layer, DenseShape chain, uint32_t k, size_t index) noexcept {
  const uint32_t inputs = k == 0 ? chain.inputs : chain.hidden,
                 outputs = k + 1 == chain.layers ? chain.outputs : chain.hidden;
  if (layer.inputs != inputs || layer.outputs != outputs)
    return corrupt("dense layer %zu: %u inputs and %u outputs, wanted %u and %u", index, layer.inputs,
                   layer.outputs, inputs, outputs);
  if (layer.padded != round_up_16(outputs))
    return corrupt("dense layer %zu: outputs padded to %u", index, layer.padded);
  return layer.reserved == 0 ? Status{} : corrupt("dense layer %zu: reserved field is not zero", index);
}

bool padding_is_zero(const DenseRecord& layer, std::span<const float> weights) noexcept {
  for (uint32_t j = layer.outputs; j < layer.padded; ++j) {
    for (uint32_t k = 0; k < layer.inputs; ++k)
      if (weights[layer.w + weight_at(layer, k, j)] != 0) return false;
    if (weights[layer.bias + j] != 0) return false;
  }
  return true;
}

// The layer's numbers start at *cursor, which moves behind them.
Status check_place(std::span<const float> weights, const DenseRecord& layer, size_t index,
                   uint64_t* cursor) noexcept {
  const uint64_t w = uint64_t{layer.inputs} * layer.padded, floats = w + layer.padded;
  if (layer.w != *cursor || layer.bias != *cursor + w || floats > weights.size() - *cursor)
    return corrupt(
        "dense layer %zu: its weights are not where the ones before end, or reach beyond the section", index);
  *cursor += floats;
  return padding_is_zero(layer, weights)
             ? Status{}
             : corrupt("dense layer %zu: padding of the weights is not zero", index);
}

// norm.node and norm.edge.
Status check_norms(std::span<const float> norms) noexcept {
  if (norms.size() != size_t{kNorms} * kNormPadded)
    return corrupt("weights: %zu numbers behind the layers, two norms make 32", norms.size());
  for (size_t at = 0; at < norms.size(); ++at) {
    const bool is_padding = at % kNormPadded >= kNormNumbers;
    if (!(is_padding ? norms[at] == 0 : norms[at] >= 0))
      return corrupt("weights: a norm is below zero, or its padding is not zero");
  }
  return {};
}

Status check_layers(const ChainsView& chains) noexcept {
  uint64_t cursor = 0;
  size_t index = 0;
  for (uint32_t c = 0; c < chain_count(*chains.record); ++c) {
    const DenseShape chain = chain_shape(*chains.record, c);
    for (uint32_t k = 0; k < chain.layers; ++k, ++index) {
      const DenseRecord& layer = chains.layers[index];
      if (Status status = check_shape(layer, chain, k, index); !status.ok()) return status;
      if (Status status = check_place(chains.weights, layer, index, &cursor); !status.ok()) return status;
    }
  }
  if (is_coping_net(chains)) return check_norms(chains.weights.subspan(cursor));
  return cursor == chains.weights.size() ? Status{} : corrupt("weights: numbers that no layer owns");
}

}  // namespace

Status check_chains(const ChainsView& chains) noexcept {
  if (Status status = check_record(chains); !status.ok()) return status;
  if (Status status = check_layers(chains); !status.ok()) return status;
  return check_finite(chains.weights, "weights");
}

Status check_dense(const PackView& pack) noexcept {
  if (pack.kind == FileKind::kCharacter)
    return core::make_status(StatusCode::kUnsupported,
                             "pack: a character's network of model %s, which this build runs in models only; "
                             "bake it with weights of alt_conv_lstm",
                             kModelNames[static_cast<uint32_t>(pack.network->model)]);
  if (!pack.layers.empty() || !pack.inputs.empty() || has_int8(pack))
    return corrupt("network: layers, inputs or int8 weights of an alt_conv_lstm in another model");
  return check_chains({pack.network, pack.dense, pack.weights});
}

}  // namespace sinew::pack
