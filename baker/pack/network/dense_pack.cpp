// dense_pack.cpp  Names and numbers of a network of chains checked, its layers laid out as the kernels read
// them.
#include "baker/pack/network/dense_pack.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "baker/common/bad_input.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "pack/dense_layout.hpp"

namespace sinew::baker {
namespace {

using pack::ModelKind;

constexpr long kNormNumbers = 6;
constexpr size_t kNormPadded = 16;

uint32_t whole_number(const Safetensors& weights, const std::string& key, uint32_t high) {
  metadata_text(weights, key);
  const float value = metadata_number(weights, key, 0, 1, static_cast<float>(high));
  if (value != std::floor(value))
    throw BadInput(weights.path + ": metadata key '" + key + "' is not a whole number");
  return static_cast<uint32_t>(value);
}

// Without the key: the paper's.
uint32_t deep_latent(const Safetensors& weights) {
  constexpr uint32_t kMost = pack::kDeepWidest / 3;
  if (!weights.metadata.contains("latent")) return kMost;
  const uint32_t latent = whole_number(weights, "latent", kMost);
  if (latent % pack::kDeepLatentStep != 0)
    throw BadInput(weights.path + ": metadata key 'latent' is " + std::to_string(latent) +
                   "; a deep_emulator has 16, 32, 48 or 64");
  return latent;
}

bool sees_from_moving_frame(const Safetensors& weights) {
  const auto found = weights.metadata.find("frame");
  if (found == weights.metadata.end()) return false;
  if (found->second != "going_on")
    throw BadInput(weights.path + ": metadata key 'frame' is '" + found->second +
                   "'; of a deep_emulator it is 'going_on', or absent for the paper's; train again");
  return true;
}

pack::NetworkRecord make_record(const Safetensors& weights) {
  pack::NetworkRecord record{};
  record.model = model_of(weights);
  if (record.model == ModelKind::kDeepEmulator) {
    metadata_text(weights, "rate_hz");
    record.rate_hz = metadata_number(weights, "rate_hz", 0, 1, 1000);
    record.max_channels = 3 * deep_latent(weights);
    record.moving = sees_from_moving_frame(weights);
  } else {
    record.max_channels = whole_number(weights, "latent", pack::kMaxLatent);
    record.blocks = whole_number(weights, "blocks", pack::kMaxBlocks);
    record.depth = whole_number(weights, "depth", pack::kMaxDepth);
  }
  record.layer_count = pack::dense_count(record);
  return record;
}

// As the weights file names a chain of pack/dense_layout.hpp.
std::string chain_name(const pack::NetworkRecord& record, uint32_t chain) {
  constexpr const char* kDeepNames[] = {"alpha.", "beta.", "gamma."};
  if (record.model == ModelKind::kDeepEmulator) return kDeepNames[chain];
  const std::string end = chain % 2 == 0 ? ".node." : ".edge.";
  if (chain < 2) return "encoder" + end;
  if (chain >= 2 * (record.blocks + 1)) return "decoder" + end;
  return "blocks." + std::to_string(chain / 2 - 1) + end;
}

class ChainLayout {
 public:
  explicit ChainLayout(const Safetensors& weights) : weights_(weights) {}

  void append_chain(const std::string& name, const pack::DenseShape& shape) {
    for (uint32_t k = 0; k < shape.layers; ++k)
      append_layer(name + std::to_string(k), k == 0 ? shape.inputs : shape.hidden,
                   k + 1 == shape.layers ? shape.outputs : shape.hidden);
  }

  void append_norm(const std::string& name) {
    const std::vector<float> norm = take(name, {kNormNumbers});
    if (std::ranges::any_of(norm, [](float v) { return v < 0; }))
      throw BadInput(weights_.path + ": tensor '" + name + "' holds a norm below 0; train or export again");
    floats_.resize(floats_.size() + kNormPadded);
    std::ranges::copy(norm, floats_.end() - kNormPadded);
  }

  // A tensor that would be passed over in silence means that the file holds another network than the one
  // baked.
  void check_no_stranger(const std::string& model) const {
    for (const auto& [name, tensor] : weights_.tensors)
      if (!taken_.contains(name))
        throw BadInput(weights_.path + ": tensor '" + name + "' is not part of a " + model +
                       " of these sizes; are the metadata right?");
  }

  const std::vector<pack::DenseRecord>& layers() const { return layers_; }
  const std::vector<float>& floats() const { return floats_; }

 private:
  std::vector<float> take(const std::string& name, const std::vector<long>& shape) {
    taken_.insert(name);
    return finite_values(weights_, name, shape);
  }

  void append_layer(const std::string& name, uint32_t inputs, uint32_t outputs) {
    const std::vector<float> w = take(name + ".weight", {outputs, inputs}),
                             bias = take(name + ".bias", {outputs});
    pack::DenseRecord layer{};
    layer.inputs = inputs;
    layer.outputs = outputs;
    layer.padded = static_cast<uint32_t>(pack::round_up_16(outputs));
    layer.w = floats_.size();
    layer.bias = layer.w + uint64_t{inputs} * layer.padded;
    floats_.resize(layer.bias + layer.padded);
    for (uint32_t j = 0; j < outputs; ++j)
      for (uint32_t k = 0; k < inputs; ++k)
        floats_[layer.w + pack::weight_at(layer, k, j)] = w[size_t{j} * inputs + k];
    std::ranges::copy(bias, floats_.begin() + static_cast<std::ptrdiff_t>(layer.bias));
    layers_.push_back(layer);
  }

  const Safetensors& weights_;
  std::set<std::string> taken_;
  std::vector<pack::DenseRecord> layers_;
  std::vector<float> floats_;
};

struct Chains {
  pack::NetworkRecord record;
  ChainLayout layout;
};

Chains lay_out_chains(const Safetensors& weights) {
  Chains chains{make_record(weights), ChainLayout(weights)};
  auto& [record, layout] = chains;
  for (uint32_t chain = 0; chain < pack::chain_count(record); ++chain)
    layout.append_chain(chain_name(record, chain), pack::chain_shape(record, chain));
  if (record.model == ModelKind::kCopingNet)
    for (const char* name : {"norm.node", "norm.edge"}) layout.append_norm(name);
  layout.check_no_stranger(pack::kModelNames[static_cast<uint32_t>(record.model)]);
  return chains;
}

}  // namespace

void add_chains(const Safetensors& weights, PackWriter& pack) {
  const auto [record, layout] = lay_out_chains(weights);
  const std::string metadata = nlohmann::json(weights.metadata).dump();
  pack.section(pack::SectionKind::kMetadata, std::vector<char>(metadata.begin(), metadata.end()));
  pack.section(pack::SectionKind::kNetwork, std::vector{record});
  pack.section(pack::SectionKind::kDense, layout.layers());
  pack.section(pack::SectionKind::kWeights, layout.floats());
}

uint64_t add_rod_network(const Safetensors& weights, PackWriter& pack) {
  if (model_of(weights) != ModelKind::kCopingNet)
    throw BadInput(weights.path + ": metadata key 'sinew.model' is '" +
                   metadata_text(weights, "sinew.model") + "'; rods start from a coping_net");
  const auto [record, layout] = lay_out_chains(weights);
  if (record.max_channels % 8 != 0 || record.max_channels > pack::kPanel)
    throw BadInput(weights.path + ": metadata key 'latent' is " + std::to_string(record.max_channels) +
                   "; rods start from a network of a multiple of 8, at most " + std::to_string(pack::kPanel));
  constexpr float kMostNorm = 1000;  // as the reader's
  for (const char* name : {"norm.node", "norm.edge"})
    for (const float norm : finite_values(weights, name, {kNormNumbers}))
      if (norm > kMostNorm)
        throw BadInput(weights.path + ": tensor '" + name +
                       "' holds a norm above 1000; train or export again");
  pack.section(pack::SectionKind::kRodNetwork, std::vector{record});
  pack.section(pack::SectionKind::kRodDense, layout.layers());
  pack.section(pack::SectionKind::kRodWeights, layout.floats());
  return layout.floats().size();
}

uint32_t add_patch_network(const Safetensors& weights, PackWriter& pack) {
  const auto [record, layout] = lay_out_chains(weights);
  pack.section(pack::SectionKind::kPatchNetwork, std::vector{record});
  pack.section(pack::SectionKind::kPatchDense, layout.layers());
  pack.section(pack::SectionKind::kPatchWeights, layout.floats());
  return record.max_channels / 3;
}

}  // namespace sinew::baker
