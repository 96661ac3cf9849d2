// dense_pack.cpp  Weights of networks of chains are refused by the name of what is wrong, and laid out as the
// format says.
#include "baker/pack/network/dense_pack.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "baker/common/bad_input.hpp"
#include "pack/dense_layout.hpp"
#include "pack/pack_view.hpp"
#include "tests/pack/packed_model.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using Catch::Contains;
using test::small_coping_net;
using test::small_deep_emulator;

namespace {

std::string refusal(const Safetensors& weights) {
  PackWriter writer(pack::FileKind::kModel);
  try {
    add_chains(weights, writer);
  } catch (const BadInput& error) {
    CHECK_THAT(error.what(), Contains(weights.path) && !Contains("\n"));
    return error.what();
  }
  return "";
}

std::string refusal_with_key(Safetensors weights, const std::string& key, const std::string& value) {
  weights.metadata[key] = value;
  return refusal(weights);
}

std::string refusal_without_key(Safetensors weights, const std::string& key) {
  weights.metadata.erase(key);
  return refusal(weights);
}

std::string refusal_with_tensor(Safetensors weights, const std::string& name, const Tensor& tensor) {
  weights.tensors[name] = tensor;
  return refusal(weights);
}

std::string refusal_without_tensor(Safetensors weights, const std::string& name) {
  weights.tensors.erase(name);
  return refusal(weights);
}

std::string refusal_with_value(Safetensors weights, const std::string& name, float value) {
  std::vector<float> values = weights.tensors.at(name).as_f32();
  values[2] = value;
  return refusal_with_tensor(weights, name, tensor_f32(weights.tensors.at(name).shape, values));
}

// How many of a layer's numbers lie where the format says.
size_t placed(const pack::PackView& view, size_t index, const Safetensors& weights, const std::string& name) {
  const pack::DenseRecord& layer = view.dense[index];
  const std::vector<float> w = weights.tensors.at(name + ".weight").as_f32(),
                           bias = weights.tensors.at(name + ".bias").as_f32();
  size_t count = 0;
  for (uint32_t j = 0; j < layer.outputs; ++j) {
    const uint32_t panel = j / 64, width = std::min(64u, layer.padded - panel * 64);
    for (uint32_t k = 0; k < layer.inputs; ++k)
      count += view.weights[layer.w + panel * 64 * layer.inputs + k * width + j % 64] ==
               w[size_t{j} * layer.inputs + k];
    count += view.weights[layer.bias + j] == bias[j];
  }
  return count;
}

size_t numbers_in(const Safetensors& weights) {
  size_t count = 0;
  for (const auto& [name, tensor] : weights.tensors) count += tensor.count();
  return count;
}

}  // namespace

TEST_CASE("chains_with_bad_metadata_are_refused_by_key") {
  const Safetensors deep = small_deep_emulator(), coping = small_coping_net();
  REQUIRE(refusal(deep).empty());
  REQUIRE(refusal(coping).empty());
  CHECK_THAT(refusal_without_key(deep, "sinew.model"), Contains("'sinew.model' is missing"));
  CHECK_THAT(refusal_with_key(deep, "sinew.model", "deep_learner"),
             Contains("'deep_learner'; this version bakes alt_conv_lstm, deep_emulator and coping_net"));
  CHECK_THAT(refusal_with_key(deep, "sinew.version", "2"), Contains("'2'; this version reads 1"));
  CHECK_THAT(refusal_without_key(deep, "rate_hz"), Contains("'rate_hz' is missing"));
  CHECK_THAT(refusal_with_key(deep, "rate_hz", "0"), Contains("'rate_hz' holds 0, which is out of range"));
  for (const char* key : {"latent", "blocks", "depth"}) {
    CHECK_THAT(refusal_without_key(coping, key), Contains("'" + std::string(key) + "' is missing"));
    CHECK_THAT(refusal_with_key(coping, key, "0"), Contains("holds 0, which is out of range"));
    CHECK_THAT(refusal_with_key(coping, key, "300"), Contains("holds 300, which is out of range"));
    CHECK_THAT(refusal_with_key(coping, key, "nan"), Contains("holds nan, which is out of range"));
    CHECK_THAT(refusal_with_key(coping, key, "1.5"), Contains("is not a whole number"));
    CHECK_THAT(refusal_with_key(coping, key, "wide"), Contains("holds 'wide', which is not a number"));
  }
}

TEST_CASE("missing_misshaped_and_not_finite_tensors_of_chains_are_refused_by_name") {
  const Tensor other = tensor_f32({2, 2}, {1, 2, 3, 4});
  for (const auto& [weights, name] : {std::pair(small_deep_emulator(), std::string("gamma.4.weight")),
                                      std::pair(small_deep_emulator(), std::string("alpha.0.bias")),
                                      std::pair(small_coping_net(), std::string("blocks.1.edge.0.weight")),
                                      std::pair(small_coping_net(), std::string("decoder.node.1.bias")),
                                      std::pair(small_coping_net(), std::string("norm.edge"))}) {
    CHECK_THAT(refusal_without_tensor(weights, name), Contains("tensor '" + name + "' is missing"));
    CHECK_THAT(refusal_with_tensor(weights, name, other),
               Contains("tensor '" + name + "' has shape (2, 2), wanted"));
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
      CHECK_THAT(refusal_with_value(weights, name, value),
                 Contains("tensor '" + name + "' holds NaN or infinity at element 2"));
  }
  CHECK_THAT(refusal_with_value(small_coping_net(), "norm.node", -1),
             Contains("'norm.node' holds a norm below 0"));
  CHECK_THAT(refusal_with_tensor(small_coping_net(), "blocks.2.node.0.weight", other),
             Contains("'blocks.2.node.0.weight' is not part of a coping_net"));
  CHECK_THAT(refusal_with_tensor(small_deep_emulator(), "norm.node", other),
             Contains("'norm.node' is not part of a deep_emulator"));
}

TEST_CASE("every_number_of_a_chain_lies_where_the_format_says") {
  const Safetensors deep = small_deep_emulator();
  const test::PackedModel packed(deep);
  const pack::PackView& view = packed.view();
  CHECK(view.network->rate_hz == 24);
  REQUIRE(view.dense.size() == 15);
  size_t count = 0, index = 0;
  for (const char* chain : {"alpha.", "beta.", "gamma."})
    for (int k = 0; k < 5; ++k) count += placed(view, index++, deep, chain + std::to_string(k));
  CHECK(count == 237571);  // the paper's count
  CHECK(count == numbers_in(deep));
}

TEST_CASE("every_number_of_a_coping_net_lies_where_the_format_says") {
  const Safetensors coping = small_coping_net();
  const test::PackedModel packed(coping);
  const pack::PackView& view = packed.view();
  CHECK(view.network->max_channels == 5);
  CHECK(view.network->blocks == 2);
  CHECK(view.network->depth == 1);
  size_t count = 0, index = 0;
  for (const char* part : {"encoder.", "blocks.0.", "blocks.1.", "decoder."})
    for (const char* end : {"node.", "edge."})
      for (int k = 0; k < 2; ++k) count += placed(view, index++, coping, part + (end + std::to_string(k)));
  for (const size_t norm : {0u, 1u})
    for (size_t k = 0; k < 6; ++k)
      count += view.weights[view.weights.size() - 32 + norm * 16 + k] == static_cast<float>(k);
  CHECK(count == numbers_in(coping));
  const auto metadata = nlohmann::json::parse(view.metadata.begin(), view.metadata.end());
  CHECK(metadata == nlohmann::json(coping.metadata));
}
