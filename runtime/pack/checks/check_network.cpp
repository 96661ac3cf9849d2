// check_network.cpp  Network records, layers, inputs and weights agree with each other.
#include <algorithm>
#include <cmath>

#include "core/status.hpp"
#include "pack/checks/checks.hpp"
#include "pack/weight_layout.hpp"

namespace sinew::pack {
namespace {

constexpr uint32_t kMaxLayers = 16, kMaxChannels = 1024, kMaxInputWidth = 1024;
constexpr float kMostScale = 1e6f, kMostInputScale = 1e12f, kLeastUnit = 1e-6f, kMostUnit = 1e6f;
constexpr uint32_t kPaperInputWidth = 9, kOutputChannels = 3;

// Floats of one node's value; 0 for a kind that this version does not know.
uint32_t input_width(InputKind kind) noexcept {
  using enum InputKind;
  if (kind == kStiffness || kind == kFrequency) return 1;
  const bool known =
      kind == kRestPosition || kind == kRestNormal || (kind >= kAngularAcceleration && kind <= kSpunVelocity);
  return known ? 3 : 0;
}

bool is_chain_model(ModelKind model) noexcept {
  return model == ModelKind::kDeepEmulator || model == ModelKind::kCopingNet;
}

bool in_unit_range(float value) noexcept { return value >= 0 && value <= 1; }

// A character may have no network.
Status check_nothing(const PackView& pack) noexcept {
  const NetworkRecord& record = *pack.network;
  if (pack.kind == FileKind::kModel) return corrupt("a model without a network");
  const bool empty = record.layer_count == 0 && record.input_width == 0 && record.max_channels == 0 &&
                     record.output_scale == 0 && record.output_leak == 0 && record.hidden_leak == 0 &&
                     record.state_clamp == 0 && record.length_unit == 0 &&
                     record.precision == Precision::kFloat32 && record.blocks == 0 && record.depth == 0 &&
                     record.moving == 0;
  if (!empty) return corrupt("network: fields of a network that is not there");
  if (!pack.layers.empty() || !pack.inputs.empty() || !pack.weights.empty() || !pack.dense.empty() ||
      has_int8(pack))
    return corrupt("network: layers, inputs or weights of a network that is not there");
  if (!is_within(record.rate_hz, kSlowest_hz, kFastest_hz))
    return corrupt("network: rate %g Hz, outside 0.1..1e4", double{record.rate_hz});
  return check_zero(record.reserved, "network", 0);
}

Status check_precision(const PackView& pack) noexcept {
  const auto precision = static_cast<uint32_t>(pack.network->precision);
  if (precision >= std::size(kPrecisionNames))
    return core::make_status(StatusCode::kUnsupported,
                             "pack: network precision %u is not known to this build; update sinew or bake it "
                             "with --precision fp32",
                             precision);
  if (pack.kind == FileKind::kCharacter && precision != 0)
    return core::make_status(StatusCode::kUnsupported,
                             "pack: the character's network is in %s, and characters run in fp32 only; bake "
                             "it again with sinew-bake character",
                             kPrecisionNames[precision]);
  if (pack.network->precision != Precision::kInt8 && has_int8(pack))
    return corrupt("network: int8 sections of a network in %s", kPrecisionNames[precision]);
  return {};
}

Status check_record(const PackView& pack) noexcept {
  const NetworkRecord& record = *pack.network;
  if (record.model != ModelKind::kAltConvLstm)
    return core::make_status(StatusCode::kUnsupported,
                             "pack: network model %u is not known to this build; update sinew",
                             static_cast<uint32_t>(record.model));
  if (record.layer_count < 1 || record.layer_count > kMaxLayers || record.layer_count != pack.layers.size())
    return corrupt("network: %u layers stated, %zu there", record.layer_count, pack.layers.size());
  if (pack.layers.back().channels != kOutputChannels)
    return corrupt("the last layer has %u channels, not 3", pack.layers.back().channels);
  if (record.input_width < 1 || record.input_width > kMaxInputWidth)
    return corrupt("network: input width %u is outside 1..1024", record.input_width);
  if (!is_within(record.rate_hz, kSlowest_hz, kFastest_hz))
    return corrupt("network: rate %g Hz, outside 0.1..1e4", double{record.rate_hz});
  if (!(std::fabs(record.output_scale) <= kMostScale))
    return corrupt("network: output scale %g", double{record.output_scale});
  if (!in_unit_range(record.output_leak) || !in_unit_range(record.hidden_leak))
    return corrupt("network: a leak is outside 0..1");
  if (!(record.state_clamp > 0)) return corrupt("network: state clamp %g", double{record.state_clamp});
  if (!is_within(record.length_unit, kLeastUnit, kMostUnit))
    return corrupt("network: length unit %g, outside 1e-6..1e6", double{record.length_unit});
  if (record.blocks != 0 || record.depth != 0 || record.moving != 0 || !pack.dense.empty())
    return corrupt("network: blocks, depth, a moving frame or dense layers, which an alt_conv_lstm has not");
  if (Status status = check_precision(pack); !status.ok()) return status;
  return check_zero(record.reserved, "network", 0);
}

Status check_inputs(const PackView& pack) noexcept {
  uint32_t seen = 0, width = 0;
  for (size_t index = 0; index < pack.inputs.size(); ++index) {
    const InputRecord& input = pack.inputs[index];
    if (input_width(input.kind) == 0)
      return corrupt("input %zu: kind %u is not known", index, static_cast<uint32_t>(input.kind));
    const uint32_t bit = 1u << static_cast<uint32_t>(input.kind);
    if ((seen & bit) != 0) return corrupt("input %zu: its kind appears twice", index);
    seen |= bit;
    width += input_width(input.kind);
    if (!(std::fabs(input.scale) <= kMostInputScale))
      return corrupt("input %zu: scale %g", index, double{input.scale});
    if (!(input.envelope > 0)) return corrupt("input %zu: envelope %g", index, double{input.envelope});
    if (input.reserved != 0) return corrupt("input %zu: reserved field is not zero", index);
  }
  const uint32_t expected = pack.inputs.empty() ? kPaperInputWidth : width;
  return pack.network->input_width == expected
             ? Status{}
             : corrupt("network: input width %u, its inputs make %u", pack.network->input_width, expected);
}

Status check_layer_record(const LayerRecord& layer, uint32_t expected_inputs, size_t index) noexcept {
  if (layer.inputs != expected_inputs)
    return corrupt("layer %zu: %u inputs, wanted %u", index, layer.inputs, expected_inputs);
  if (layer.channels < 1 || layer.channels > kMaxChannels)
    return corrupt("layer %zu: %u channels, outside 1..1024", index, layer.channels);
  if (layer.padded != round_up_16(layer.channels))
    return corrupt("layer %zu: channels padded to %u", index, layer.padded);
  if (layer.has_self > 1) return corrupt("layer %zu: has_self is neither 0 nor 1", index);
  if (layer.reserved != 0) return corrupt("layer %zu: reserved field is not zero", index);
  return {};
}

// One tensor of rows x gates x padded that must start at *cursor; moves *cursor behind it.
struct TensorPlace {
  uint64_t offset;
  uint32_t rows, gates;
  uint64_t (*at)(const LayerRecord& layer, uint64_t rows, uint64_t row, uint64_t gate, uint64_t channel);
};

uint64_t gates_at(const LayerRecord&, uint64_t rows, uint64_t row, uint64_t gate, uint64_t channel) {
  return gate_weight_at(rows, 4, row, gate, channel);
}
uint64_t peepholes_at(const LayerRecord& layer, uint64_t, uint64_t row, uint64_t gate, uint64_t channel) {
  return peephole_at(layer, row, gate, channel);
}
uint64_t bias_at(const LayerRecord& layer, uint64_t, uint64_t, uint64_t gate, uint64_t channel) {
  return gate * layer.padded + channel;
}

Status check_tensor(const PackView& pack, const LayerRecord& layer, size_t index, TensorPlace tensor,
                    uint64_t* cursor) noexcept {
  const uint64_t floats = uint64_t{tensor.rows} * tensor.gates * layer.padded;
  if (tensor.offset != *cursor || floats > pack.weights.size() - *cursor)
    return corrupt("layer %zu: a tensor is not where the one before it ends, or reaches beyond the weights",
                   index);
  for (uint32_t row = 0; row < tensor.rows; ++row) {
    for (uint32_t gate = 0; gate < tensor.gates; ++gate) {
      for (uint32_t channel = layer.channels; channel < layer.padded; ++channel) {
        if (pack.weights[*cursor + tensor.at(layer, tensor.rows, row, gate, channel)] != 0)
          return corrupt("layer %zu: padding of the weights is not zero", index);
      }
    }
  }
  *cursor += floats;
  return {};
}

Status check_tensors(const PackView& pack, const LayerRecord& layer, size_t index,
                     uint64_t* cursor) noexcept {
  const TensorPlace tensors[] = {{layer.w_x, layer.inputs, 4, gates_at},
                                 {layer.w_s, layer.has_self != 0 ? layer.inputs : 0, 4, gates_at},
                                 {layer.w_h, layer.channels, 4, gates_at},
                                 {layer.w_y, layer.channels, 3, peepholes_at},
                                 {layer.bias, 1, 4, bias_at}};
  for (TensorPlace tensor : tensors) {
    if (tensor.rows == 0 && tensor.offset != 0)
      return corrupt("layer %zu: an offset of self weights that are not there", index);
    if (tensor.rows == 0) continue;
    if (Status status = check_tensor(pack, layer, index, tensor, cursor); !status.ok()) return status;
  }
  return {};
}

Status check_layers(const PackView& pack) noexcept {
  uint64_t cursor = 0;
  uint32_t inputs = pack.network->input_width, widest = 0;
  for (size_t index = 0; index < pack.layers.size(); ++index) {
    const LayerRecord& layer = pack.layers[index];
    if (Status status = check_layer_record(layer, inputs, index); !status.ok()) return status;
    if (Status status = check_tensors(pack, layer, index, &cursor); !status.ok()) return status;
    inputs = layer.channels;
    widest = std::max(widest, layer.channels);
  }
  if (widest != pack.network->max_channels)
    return corrupt("network: widest layer %u stated, %u there", pack.network->max_channels, widest);
  return cursor == pack.weights.size() ? Status{} : corrupt("weights: numbers that no layer owns");
}

Status check_weights(const PackView& pack) noexcept { return check_finite(pack.weights, "weights"); }

}  // namespace

Status check_network(const PackView& pack) noexcept {
  if (pack.network == nullptr) return corrupt("it has no network record, or more than one");
  if (!has_network(pack)) return check_nothing(pack);
  if (is_chain_model(pack.network->model)) return check_dense(pack);
  constexpr Check kChecks[] = {check_record, check_inputs, check_layers, check_weights};
  return run_checks(kChecks, pack);
}

}  // namespace sinew::pack
