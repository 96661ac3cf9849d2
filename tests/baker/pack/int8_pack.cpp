// int8_pack.cpp  Ranges that cannot scale a network are refused; those that can make the scales.
#include "baker/pack/network/int8_pack.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "baker/common/bad_input.hpp"
#include "baker/pack/network/int8_layout.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using Catch::Contains;

namespace {

// Of small_paper_weights: one hidden layer, 9 inputs, 5 channels.
constexpr size_t kInputs = 9, kChannels = 5, kPadded = 16;

HeardRanges all_ones() {
  const std::vector<float> inputs(kInputs, 1.0f), channels(kChannels, 1.0f);
  return {inputs, inputs, channels, channels};
}

std::string refusal(const std::vector<HeardRanges>& ranges) {
  PackWriter writer(pack::FileKind::kModel);
  try {
    add_network(test::small_paper_weights(), writer, pack::Precision::kInt8, ranges);
  } catch (const BadInput& error) {
    CHECK_THAT(error.what(), Contains("calibrate again") && !Contains("\n"));
    return error.what();
  }
  return "";
}

std::string refusal_after(std::vector<float> HeardRanges::*kind, auto damage) {
  HeardRanges ranges = all_ones();
  damage(ranges.*kind);
  return refusal({ranges});
}

// One hidden layer whose weights are all 1/2, and a last one.
struct HalfWeights {
  HalfWeights() {
    pack::LayerRecord hidden{}, last{};
    hidden.inputs = kInputs, hidden.channels = kChannels, hidden.padded = kPadded;
    hidden.w_h = size_t{4} * kPadded * kInputs;
    hidden.w_y = hidden.w_h + size_t{4} * kPadded * kChannels;
    layers = {hidden, last};
    floats.assign(hidden.w_y + size_t{3} * kPadded * kChannels, 0.5f);
  }
  Int8Sections quantized(const HeardRanges& ranges) const {
    return quantize_network(layers, floats, std::vector{ranges});
  }
  std::vector<pack::LayerRecord> layers;
  std::vector<float> floats;
};

// Of per_unit [P h padded][P y padded], then scale [columns].
constexpr size_t kFirstY = kPadded, kFirstScale = 2 * kPadded;

}  // namespace

TEST_CASE("ranges_that_are_not_this_networks_or_not_finite_are_refused_by_layer_and_kind") {
  CHECK(refusal({all_ones()}).empty());
  CHECK_THAT(refusal({}), Contains("0 layers, wanted 1"));
  CHECK_THAT(refusal({all_ones(), all_ones()}), Contains("2 layers, wanted 1"));
  struct Kind {
    std::vector<float> HeardRanges::*ranges;
    const char* name;
  };
  for (const Kind& kind : {Kind{&HeardRanges::px, "layer 0: P x "}, Kind{&HeardRanges::x, "layer 0: x "},
                           Kind{&HeardRanges::h, "layer 0: P h "}, Kind{&HeardRanges::y, "layer 0: P y "}}) {
    const auto after = [&](auto damage) { return refusal_after(kind.ranges, damage); };
    CHECK_THAT(after([](auto& r) { r.clear(); }), Contains(kind.name) && Contains("has 0 channels, wanted"));
    CHECK_THAT(after([](auto& r) { r.pop_back(); }), Contains(kind.name) && Contains("channels, wanted"));
    CHECK_THAT(after([](auto& r) { r.push_back(1); }), Contains(kind.name) && Contains("channels, wanted"));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(), -1.0f})
      CHECK_THAT(after([&](auto& r) { r[3] = bad; }),
                 Contains(kind.name) && Contains("below 0 or not finite"));
  }
}

TEST_CASE("a_range_becomes_127_and_nothing_in_the_padding") {
  HeardRanges ranges = all_ones();
  ranges.h = {1, 2, 4, 8, 16};
  const Int8Sections made = HalfWeights().quantized(ranges);
  for (size_t k = 0; k < kPadded; ++k) {
    const double expected = k < kChannels ? 127 / std::exp2(static_cast<double>(k)) : 0;
    CHECK(made.scales[k] == Approx(expected).epsilon(1e-6));  // a few roundings of float32
    CHECK(made.scales[kFirstY + k] == Approx(k < kChannels ? 127 : 0).epsilon(1e-6));
  }
}

TEST_CASE("a_channel_that_hardly_moved_is_given_a_sixteenth_of_the_widest_of_its_kind") {
  HeardRanges ranges = all_ones();
  ranges.h = {32, 2.5f, 2, 1, 0};
  const Int8Sections made = HalfWeights().quantized(ranges);
  const double expected[] = {127.0 / 32, 127 / 2.5, 127.0 / 2, 127.0 / 2, 127.0 / 2};
  for (size_t k = 0; k < kChannels; ++k) CHECK(made.scales[k] == Approx(expected[k]).epsilon(1e-6));
  CHECK(made.scales[kFirstY] == Approx(127).epsilon(1e-6));  // P y is another kind
}

TEST_CASE("kinds_that_never_moved_are_scaled_by_a_finite_number") {
  HeardRanges ranges = all_ones();
  ranges.h.assign(kChannels, 0);
  for (const float scale : HalfWeights().quantized(ranges).scales)
    CHECK((scale >= 0 && std::isfinite(scale)));
}

// The widest channel's weights are its column's largest: range / 127 times 1/2, rounded to 127.
TEST_CASE("the_largest_weight_of_a_column_in_units_of_what_it_hears_becomes_127") {
  HeardRanges ranges = all_ones();
  ranges.h = {8, 6, 2, 1, 1};
  const HalfWeights network;
  const Int8Sections made = network.quantized(ranges);
  const Int8Extent extent = int8_extent(network.layers[0], true);
  REQUIRE(made.weights.size() == extent.weights);
  REQUIRE(made.sums.size() == extent.sums);
  REQUIRE(made.scales.size() == extent.scales);
  CHECK(made.scales[kFirstScale] == Approx(8.0 / 127 * 0.5 / 127).epsilon(1e-6));
  const int8_t expected[] = {127, 95, 32, 16};  // 127 times 1, 3/4, 1/4, 1/8, to the nearest
  for (size_t k = 0; k < 4; ++k) CHECK(int{made.weights[k]} == int{expected[k]});
}
