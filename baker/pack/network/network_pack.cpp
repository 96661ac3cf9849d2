// network_pack.cpp  A weights file to the network sections: names and numbers checked, tensors laid out as
// the kernels read them.
#include "baker/pack/network/network_pack.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "baker/common/bad_input.hpp"
#include "pack/weight_layout.hpp"

namespace sinew::baker {
namespace {

using pack::InputKind;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kSmallest = std::numeric_limits<float>::min();
constexpr size_t kMaxLayers = 16, kMaxChannels = 1024;
constexpr uint32_t kPaperInputWidth = 9;

struct InputName {
  InputKind kind;
  const char* name;
  uint32_t width;
};
constexpr InputName kInputNames[] = {{InputKind::kRestPosition, "rest_position", 3},
                                     {InputKind::kRestNormal, "rest_normal", 3},
                                     {InputKind::kStiffness, "stiffness", 1},
                                     {InputKind::kAngularAcceleration, "angular_acceleration", 3},
                                     {InputKind::kAngularVelocity, "angular_velocity", 3},
                                     {InputKind::kGravityChange, "gravity_change", 3},
                                     {InputKind::kDisplacement, "displacement", 3},
                                     {InputKind::kVelocity, "velocity", 3},
                                     {InputKind::kFeltStep, "felt_step", 3},
                                     {InputKind::kBaseStep, "base_step", 3},
                                     {InputKind::kTurn, "turn", 3},
                                     {InputKind::kFrequency, "frequency", 1},
                                     {InputKind::kBend, "bend", 3},
                                     {InputKind::kBentForce, "bent_force", 3},
                                     {InputKind::kBentStep, "bent_step", 3},
                                     {InputKind::kBentDisplacement, "bent_displacement", 3},
                                     {InputKind::kTurnedForce, "turned_force", 3},
                                     {InputKind::kTurnedStep, "turned_step", 3},
                                     {InputKind::kTurnedVelocity, "turned_velocity", 3},
                                     {InputKind::kSpunStep, "spun_step", 3},
                                     {InputKind::kSpunVelocity, "spun_velocity", 3}};

// ---- metadata ----

[[noreturn]] void refuse_key(const Safetensors& weights, const std::string& key, const std::string& what) {
  throw BadInput(weights.path + ": metadata key '" + key + "' " + what);
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (size_t at = 0; at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    parts.push_back(trimmed(text.substr(at, comma - at)));
    at = comma + 1;
  }
  return parts;
}

float parse_number(const Safetensors& weights, const std::string& key, const std::string& text) {
  const std::string digits = trimmed(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    refuse_key(weights, key, "holds '" + text + "', which is not a number");
  return static_cast<float>(value);
}

std::vector<float> parse_numbers(const Safetensors& weights, const std::string& key, size_t count) {
  const std::vector<std::string> parts = split(metadata_text(weights, key));
  if (parts.size() != count)
    refuse_key(weights, key,
               "holds " + std::to_string(parts.size()) + " numbers for " + std::to_string(count) + " inputs");
  std::vector<float> numbers;
  for (const std::string& part : parts) numbers.push_back(parse_number(weights, key, part));
  return numbers;
}

std::vector<uint32_t> parse_channels(const Safetensors& weights) {
  std::vector<uint32_t> channels;
  for (const std::string& part : split(metadata_text(weights, "channels"))) {
    const float value = parse_number(weights, "channels", part);
    if (!(value >= 1 && value <= kMaxChannels) || value != std::floor(value))
      refuse_key(weights, "channels", "holds '" + part + "'; wanted whole numbers from 1 to 1024");
    channels.push_back(static_cast<uint32_t>(value));
  }
  if (channels.size() > kMaxLayers) refuse_key(weights, "channels", "names more than 16 layers");
  if (channels.back() != 3) refuse_key(weights, "channels", "does not end in 3, the output's x y z");
  return channels;
}

// ---- inputs ----

const InputName* find_input(const std::string& name) {
  const auto* found =
      std::ranges::find_if(kInputNames, [&](const InputName& input) { return name == input.name; });
  return found != std::end(kInputNames) ? found : nullptr;
}

pack::InputRecord make_input(const Safetensors& weights, const std::string& name, float scale,
                             float envelope) {
  const InputName* input = find_input(name);
  if (input == nullptr) {
    std::string known;
    for (const InputName& each : kInputNames) known += std::string(known.empty() ? "" : " ") + each.name;
    refuse_key(weights, "inputs",
               "names '" + name + "', which this version does not have: train again; known are " + known);
  }
  if (!std::isfinite(scale)) refuse_key(weights, "input_scales", "is not finite for '" + name + "'");
  if (!(envelope > 0)) refuse_key(weights, "envelope", "is not above 0 for '" + name + "'");
  return {input->kind, scale, envelope, 0};
}

std::vector<pack::InputRecord> parse_inputs(const Safetensors& weights) {
  std::vector<pack::InputRecord> inputs;
  if (!weights.metadata.contains("inputs")) return inputs;
  const std::vector<std::string> names = split(weights.metadata.at("inputs"));
  const std::vector<float> scales = parse_numbers(weights, "input_scales", names.size());
  const std::vector<float> envelope = weights.metadata.contains("envelope")
                                          ? parse_numbers(weights, "envelope", names.size())
                                          : std::vector<float>(names.size(), kInfinity);
  for (size_t k = 0; k < names.size(); ++k) {
    inputs.push_back(make_input(weights, names[k], scales[k], envelope[k]));
    if (std::count(names.begin(), names.end(), names[k]) > 1)
      refuse_key(weights, "inputs", "names '" + names[k] + "' twice");
  }
  return inputs;
}

uint32_t total_width(const std::vector<pack::InputRecord>& inputs) {
  uint32_t width = 0;
  for (const pack::InputRecord& input : inputs) width += input_width(input.kind);
  return inputs.empty() ? kPaperInputWidth : width;
}

// ---- tensors ----

// Tensors [rows][gates * channels] appended as pack/weight_layout.hpp has them.
class WeightLayout {
 public:
  explicit WeightLayout(const Safetensors& weights) : weights_(weights) {}

  uint64_t append(const std::string& name, const pack::LayerRecord& layer, uint32_t rows, uint32_t gates) {
    const long columns = static_cast<long>(gates) * layer.channels;
    const bool vector = name.ends_with(".b");
    const std::vector<float> values = finite_values(
        weights_, name,
        vector ? std::vector<long>{columns} : std::vector<long>{static_cast<long>(rows), columns});
    const uint64_t offset = floats_.size();
    floats_.resize(offset + size_t{rows} * gates * layer.padded, 0.0f);
    const auto place = [&](size_t row, size_t gate, size_t channel) {
      if (vector) return gate * layer.padded + channel;
      return gates == 4 ? pack::gate_weight_at(rows, gates, row, gate, channel)
                        : pack::peephole_at(layer, row, gate, channel);
    };
    auto value = values.begin();
    for (size_t row = 0; row < rows; ++row)
      for (size_t gate = 0; gate < gates; ++gate)
        for (size_t j = 0; j < layer.channels; ++j) floats_[offset + place(row, gate, j)] = *value++;
    return offset;
  }

  pack::LayerRecord append_layer(size_t index, uint32_t inputs, uint32_t channels) {
    const std::string prefix = "layers." + std::to_string(index) + ".";
    pack::LayerRecord layer{};
    layer.inputs = inputs;
    layer.channels = channels;
    layer.padded = static_cast<uint32_t>(pack::round_up_16(channels));
    layer.has_self = weights_.tensors.contains(prefix + "W_s") ? 1 : 0;
    layer.w_x = append(prefix + "W_x", layer, inputs, 4);
    if (layer.has_self != 0) layer.w_s = append(prefix + "W_s", layer, inputs, 4);
    layer.w_h = append(prefix + "W_h", layer, channels, 4);
    layer.w_y = append(prefix + "W_y", layer, channels, 3);
    layer.bias = append(prefix + "b", layer, 1, 4);
    return layer;
  }

  const std::vector<float>& floats() const { return floats_; }

 private:
  const Safetensors& weights_;
  std::vector<float> floats_;
};

// A tensor that would be passed over in silence means that the file holds another network than the one baked.
void check_no_stranger(const Safetensors& weights, size_t layers) {
  constexpr const char* kNames[] = {"W_x", "W_s", "W_h", "W_y", "b"};
  for (const auto& [name, tensor] : weights.tensors) {
    bool known = false;
    for (size_t l = 0; l < layers; ++l)
      for (const char* part : kNames) known = known || name == "layers." + std::to_string(l) + "." + part;
    if (!known)
      throw BadInput(weights.path + ": tensor '" + name + "' is not part of an alt_conv_lstm of " +
                     std::to_string(layers) + " layers; is the metadata key 'channels' right?");
  }
}

pack::NetworkRecord make_record(const Safetensors& weights, const std::vector<uint32_t>& channels) {
  metadata_text(weights, "rate_hz");
  pack::NetworkRecord record{};
  record.model = pack::ModelKind::kAltConvLstm;
  record.layer_count = static_cast<uint32_t>(channels.size());
  record.max_channels = *std::max_element(channels.begin(), channels.end());
  record.rate_hz = metadata_number(weights, "rate_hz", 0, 1, 1000);
  record.output_scale = metadata_number(weights, "output_scale", 1, -kLargest, kLargest);
  record.output_leak = metadata_number(weights, "output_leak", 0, 0, 1);
  record.hidden_leak = metadata_number(weights, "hidden_leak", 0, 0, 1);
  record.state_clamp = metadata_number(weights, "state_clamp", kInfinity, kSmallest, kInfinity);
  record.length_unit = metadata_number(weights, "length_unit", 1, kSmallest, kLargest);
  return record;
}

void add_int8(const Int8Sections& sections, PackWriter& pack) {
  pack.section(pack::SectionKind::kInt8Weights, sections.weights);
  pack.section(pack::SectionKind::kInt8Sums, sections.sums);
  pack.section(pack::SectionKind::kInt8Scales, sections.scales);
}

}  // namespace

pack::ModelKind model_of(const Safetensors& weights) {
  const std::string& model = metadata_text(weights, "sinew.model");
  const auto* found = std::find(std::begin(pack::kModelNames) + 1, std::end(pack::kModelNames), model);
  if (found == std::end(pack::kModelNames))
    refuse_key(weights, "sinew.model",
               "is '" + model + "'; this version bakes alt_conv_lstm, deep_emulator and coping_net");
  const std::string& version = metadata_text(weights, "sinew.version");
  if (version != "1")
    refuse_key(weights, "sinew.version", "is '" + version + "'; this version reads 1: train or export again");
  return static_cast<pack::ModelKind>(found - std::begin(pack::kModelNames));
}

void check_model(const Safetensors& weights) {
  if (model_of(weights) != pack::ModelKind::kAltConvLstm)
    refuse_key(weights, "sinew.model",
               "is '" + metadata_text(weights, "sinew.model") +
                   "', which `sinew-bake model` bakes; characters take alt_conv_lstm here, a deep_emulator "
                   "by --emulator "
                   "and a coping_net by --rods");
}

const char* input_name(InputKind kind) {
  for (const InputName& input : kInputNames)
    if (input.kind == kind) return input.name;
  return "unknown";
}

uint32_t input_width(InputKind kind) {
  const InputName* input = find_input(input_name(kind));
  return input != nullptr ? input->width : 0;
}

const std::string& metadata_text(const Safetensors& weights, const std::string& key) {
  const auto found = weights.metadata.find(key);
  if (found == weights.metadata.end())
    refuse_key(weights, key, "is missing; is this a file of trained weights?");
  return found->second;
}

float metadata_number(const Safetensors& weights, const std::string& key, float fallback, float low,
                      float high) {
  const auto found = weights.metadata.find(key);
  if (found == weights.metadata.end()) return fallback;
  const float value = parse_number(weights, key, found->second);
  if (!(value >= low && value <= high))
    refuse_key(weights, key, "holds " + found->second + ", which is out of range");
  return value;
}

std::vector<float> finite_values(const Safetensors& weights, const std::string& name,
                                 const std::vector<long>& shape) {
  std::vector<float> values = weights.need(name, shape).as_f32();
  const auto bad = std::ranges::find_if(values, [](float v) { return !std::isfinite(v); });
  if (bad != values.end())
    throw BadInput(weights.path + ": tensor '" + name + "' holds NaN or infinity at element " +
                   std::to_string(bad - values.begin()) +
                   "; the training diverged, take an earlier checkpoint");
  return values;
}

std::vector<pack::LayerRecord> add_network(const Safetensors& weights, PackWriter& pack,
                                           pack::Precision precision, std::span<const HeardRanges> ranges) {
  check_model(weights);
  const std::vector<uint32_t> channels = parse_channels(weights);
  const std::vector<pack::InputRecord> inputs = parse_inputs(weights);
  pack::NetworkRecord record = make_record(weights, channels);
  record.input_width = total_width(inputs);
  record.precision = precision;

  WeightLayout layout(weights);
  std::vector<pack::LayerRecord> layers;
  for (size_t l = 0; l < channels.size(); ++l)
    layers.push_back(layout.append_layer(l, l == 0 ? record.input_width : channels[l - 1], channels[l]));
  check_no_stranger(weights, layers.size());

  const std::string metadata = nlohmann::json(weights.metadata).dump();
  pack.section(pack::SectionKind::kMetadata, std::vector<char>(metadata.begin(), metadata.end()));
  pack.section(pack::SectionKind::kNetwork, std::vector{record});
  pack.section(pack::SectionKind::kLayers, layers);
  pack.section(pack::SectionKind::kInputs, inputs);
  pack.section(pack::SectionKind::kWeights, layout.floats());
  if (precision == pack::Precision::kInt8) add_int8(quantize_network(layers, layout.floats(), ranges), pack);
  return layers;
}

}  // namespace sinew::baker
