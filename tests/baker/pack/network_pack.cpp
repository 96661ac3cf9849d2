// network_pack.cpp  Weights are refused by the name of what is wrong, and laid out as the format says.
#include "baker/pack/network/network_pack.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "baker/common/bad_input.hpp"
#include "pack/pack_view.hpp"
#include "pack/weight_layout.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using Catch::Contains;
using test::small_paper_weights;
using test::small_weights;

namespace {

std::string refusal(const Safetensors& weights) {
  PackWriter writer(pack::FileKind::kModel);
  try {
    add_network(weights, writer);
  } catch (const BadInput& error) {
    CHECK_THAT(error.what(), Contains("small.safetensors") && !Contains("\n"));
    return error.what();
  }
  return "";
}

std::string refusal_with_key(const std::string& key, const std::string& value) {
  Safetensors weights = small_weights();
  weights.metadata[key] = value;
  return refusal(weights);
}

std::string refusal_without_key(const std::string& key) {
  Safetensors weights = small_weights();
  weights.metadata.erase(key);
  return refusal(weights);
}

std::string refusal_with_value(const std::string& tensor, float value) {
  Safetensors weights = small_weights();
  std::vector<float> values = weights.tensors.at(tensor).as_f32();
  values[2] = value;
  weights.tensors[tensor] = tensor_f32(weights.tensors.at(tensor).shape, values);
  return refusal(weights);
}

test::PackEditor packed(const Safetensors& weights) {
  PackWriter writer(pack::FileKind::kModel);
  add_network(weights, writer);
  return test::PackEditor(writer.finish());
}

}  // namespace

TEST_CASE("weights_with_bad_metadata_are_refused_by_key") {
  CHECK_THAT(refusal_without_key("sinew.model"), Contains("'sinew.model' is missing"));
  CHECK_THAT(refusal_without_key("sinew.version"), Contains("'sinew.version' is missing"));
  CHECK_THAT(refusal_without_key("channels"), Contains("'channels' is missing"));
  CHECK_THAT(refusal_without_key("rate_hz"), Contains("'rate_hz' is missing"));
  CHECK_THAT(refusal_without_key("input_scales"), Contains("'input_scales' is missing"));
  CHECK_THAT(refusal_with_key("sinew.model", "coping_net"),
             Contains("'coping_net', which `sinew-bake model` bakes; characters take alt_conv_lstm here"));
  CHECK_THAT(refusal_with_key("sinew.model", "coping"),
             Contains("'coping'; this version bakes alt_conv_lstm, deep_emulator and coping_net"));
  CHECK_THAT(refusal_with_key("sinew.version", "2"), Contains("'2'; this version reads 1"));
  CHECK_THAT(refusal_with_key("channels", "5,x"), Contains("'channels' holds 'x', which is not a number"));
  CHECK_THAT(refusal_with_key("channels", "5,2.5"), Contains("'2.5'; wanted whole numbers"));
  CHECK_THAT(refusal_with_key("channels", "0,3"), Contains("'0'; wanted whole numbers"));
  CHECK_THAT(refusal_with_key("channels", "5,4"), Contains("does not end in 3"));
  CHECK_THAT(refusal_with_key("channels", "1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,3"),
             Contains("more than 16 layers"));
  CHECK_THAT(refusal_with_key("rate_hz", "fast"), Contains("'rate_hz' holds 'fast'"));
  CHECK_THAT(refusal_with_key("rate_hz", "nan"), Contains("'rate_hz' holds nan, which is out of range"));
  CHECK_THAT(refusal_with_key("output_leak", "1.5"),
             Contains("'output_leak' holds 1.5, which is out of range"));
  CHECK_THAT(refusal_with_key("state_clamp", "0"), Contains("'state_clamp'"));
  CHECK_THAT(refusal_with_key("length_unit", "-1"), Contains("'length_unit'"));
  CHECK_THAT(refusal_with_key("inputs", "displacement,speed"),
             Contains("'input_scales' holds 12 numbers for 2 inputs"));
  CHECK_THAT(refusal_with_key("input_scales", "1,2"),
             Contains("'input_scales' holds 2 numbers for 12 inputs"));
  CHECK_THAT(refusal_with_key("input_scales", "1,1,1,1,1,1,1,1,1,1,1,inf"),
             Contains("not finite for 'frequency'"));
  CHECK_THAT(refusal_with_key("envelope", "1,1,1,1,1,1,1,1,1,1,1,0"),
             Contains("not above 0 for 'frequency'"));
}

TEST_CASE("unknown_and_repeated_inputs_are_refused_by_name") {
  Safetensors weights = small_weights();
  weights.metadata["inputs"].replace(0, std::string("rest_position").size(), "rest_place");
  CHECK_THAT(
      refusal(weights),
      Contains("names 'rest_place', which this version does not have: train again; known are rest_position"));
  weights = small_weights();
  weights.metadata["inputs"].replace(0, std::string("rest_position").size(), "displacement");
  CHECK_THAT(refusal(weights), Contains("names 'displacement' twice"));
}

TEST_CASE("missing_misshaped_and_not_finite_tensors_are_refused_by_name") {
  for (const char* part : {"W_x", "W_h", "W_y", "b"}) {
    const std::string name = std::string("layers.1.") + part;
    Safetensors weights = small_weights();
    weights.tensors.erase(name);
    CHECK_THAT(refusal(weights), Contains("tensor '" + name + "' is missing"));
    weights.tensors[name] = tensor_f32({2, 2}, {1, 2, 3, 4});
    CHECK_THAT(refusal(weights), Contains("tensor '" + name + "' has shape (2, 2), wanted"));
    CHECK_THAT(refusal_with_value(name, std::numeric_limits<float>::quiet_NaN()),
               Contains("tensor '" + name + "' holds NaN or infinity at element 2"));
    CHECK_THAT(refusal_with_value(name, std::numeric_limits<float>::infinity()), Contains(name));
  }
  Safetensors weights = small_weights();
  weights.tensors["layers.1.W_s"] = tensor_f32({1}, {1});
  CHECK_THAT(refusal(weights), Contains("tensor 'layers.1.W_s' has shape (1), wanted (5, 12)"));
  weights = small_weights();
  weights.tensors["layers.2.W_x"] = tensor_f32({1}, {1});
  CHECK_THAT(refusal(weights), Contains("tensor 'layers.2.W_x' is not part of an alt_conv_lstm of 2 layers"));
}

TEST_CASE("every_weight_lies_where_the_format_says") {
  const Safetensors weights = small_weights();
  test::PackEditor editor = packed(weights);
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  size_t placed = 0;
  for (size_t l = 0; l < view.layers.size(); ++l) {
    const pack::LayerRecord& layer = view.layers[l];
    const std::string prefix = "layers." + std::to_string(l) + ".";
    const auto place = [&](size_t rows, size_t gates, size_t row, size_t gate, size_t k) {
      if (rows == 1) return gate * layer.padded + k;
      return gates == 4 ? pack::gate_weight_at(rows, gates, row, gate, k)
                        : pack::peephole_at(layer, row, gate, k);
    };
    const auto check = [&](const char* name, uint64_t offset, size_t rows, size_t gates) {
      const std::vector<float> values = weights.tensors.at(prefix + name).as_f32();
      for (size_t row = 0; row < rows; ++row)
        for (size_t gate = 0; gate < gates; ++gate)
          for (size_t k = 0; k < layer.channels; ++k, ++placed)
            if (view.weights[offset + place(rows, gates, row, gate, k)] !=
                values[(row * gates + gate) * layer.channels + k])
              FAIL_CHECK(prefix << name << " row " << row << " gate " << gate << " channel " << k);
    };
    check("W_x", layer.w_x, layer.inputs, 4);
    check("W_s", layer.w_s, layer.inputs, 4);
    check("W_h", layer.w_h, layer.channels, 4);
    check("W_y", layer.w_y, layer.channels, 3);
    check("b", layer.bias, 1, 4);
  }
  size_t there = 0;
  for (const auto& [name, tensor] : weights.tensors) there += tensor.count();
  CHECK(placed == there);
}

TEST_CASE("metadata_become_the_record_and_unknown_keys_are_kept") {
  test::PackEditor editor = packed(small_weights());
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  CHECK(view.network->input_width == 32);
  CHECK(view.network->rate_hz == 60.0f);
  CHECK(view.network->output_scale == 0.5f);
  CHECK(view.network->output_leak == 0.1f);
  CHECK(view.network->hidden_leak == 0.2f);
  CHECK(view.network->state_clamp == 8.0f);
  CHECK(view.network->length_unit == 0.01f);
  REQUIRE(view.inputs.size() == 12);
  CHECK(std::string(input_name(view.inputs[3].kind)) == "angular_acceleration");
  CHECK(view.inputs[3].scale == 0.01f);
  CHECK(view.inputs[3].envelope == 8.0f);
  const auto metadata = nlohmann::json::parse(view.metadata.begin(), view.metadata.end());
  CHECK(metadata == nlohmann::json(small_weights().metadata));
  CHECK(metadata["made_by"] == "a key that nobody knows");
}

TEST_CASE("without_inputs_the_paper_s_wiring_is_packed") {
  test::PackEditor editor = packed(small_paper_weights());
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  CHECK(view.network->input_width == 9);
  CHECK(view.network->output_scale == 1.0f);
  CHECK(view.network->output_leak == 0.0f);
  CHECK(view.network->state_clamp == std::numeric_limits<float>::infinity());
  CHECK(view.inputs.empty());
  CHECK(view.layers[0].has_self == 0);
}
