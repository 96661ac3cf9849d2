// int8.cpp  Networks whose hidden products are of bytes: near the equations in double, the same bits on
// every target with FMA, and nothing that is not finite is lost in rounding.
#include <cstring>
#include <memory>

#include "baker/pack/network/int8_pack.hpp"
#include "baker/research/precision/reduced_network.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/tissue/reference_network.hpp"

using namespace sinew;

namespace {

// A weight is rounded by 1/254 of its column's largest, what is heard by 1/254 of its range; through up to
// 240 terms, three layers and twelve steps that is 0.02 of an output of order one, measured; a wrong term is
// tenths.
constexpr double kInt8RollOut = 0.08;

// The wiring that ships: leaks and a clamp, so that the ranges are known: |c| <= 1/2, |P c| <= 1, |P h| <= 1,
// |P y| <= 1 / hidden_leak for rows of P that add up to less than 2.
pack::NetworkRecord shipped_record() {
  pack::NetworkRecord record = test::plain_record();
  record.output_scale = 0.3f;
  record.output_leak = 0.05f;
  record.hidden_leak = 0.2f;
  record.state_clamp = 0.5f;
  record.precision = pack::Precision::kInt8;
  return record;
}

struct Int8Twins {
  Int8Twins(uint32_t nodes, const std::vector<size_t>& widths, bool has_self)
      : random(nodes),
        graph(test::ring_with_chords(nodes)),
        layers(make_layers(widths, has_self)),
        packed(shipped_record(), layers),
        nodes(nodes) {
    quantize();
    state = std::make_unique<test::Floats>(state_floats(view(), nodes));
    scratch = std::make_unique<test::Floats>(scratch_floats(view(), nodes), 1e30f);
    for (const test::PlainLayer& layer : layers) {
      const test::Rows zero(nodes * layer.channels, 0.0);
      reference.push_back({zero, zero, zero});
    }
  }
  std::vector<test::PlainLayer> make_layers(const std::vector<size_t>& widths, bool has_self) {
    std::vector<test::PlainLayer> out;
    for (size_t l = 0; l + 1 < widths.size(); ++l)
      out.push_back(test::random_layer(random, widths[l], widths[l + 1], has_self));
    return out;
  }
  void quantize() {
    std::vector<baker::HeardRanges> ranges;
    size_t floats = 0;
    for (const test::PlainLayer& layer : layers) {
      const auto all = [](size_t count, float range) { return std::vector<float>(count, range); };
      ranges.push_back(
          {all(layer.inputs, 1), all(layer.inputs, 0.5f), all(layer.channels, 1), all(layer.channels, 5)});
      floats += simd::pad_to_block(layer.channels) * (8 * layer.inputs + 7 * layer.channels + 4);
    }
    ranges.pop_back();  // the last layer is of floats
    const tissue::Network network = packed.view();
    const baker::Int8Sections made =
        baker::quantize_network(network.layers, {network.weights, floats}, ranges);
    weights = std::make_unique<test::Floats>(made.weights.size() / 4);
    sums = std::make_unique<test::Floats>(made.sums.size());
    scales = std::make_unique<test::Floats>(made.scales.size());
    std::memcpy(weights->data(), made.weights.data(), made.weights.size());
    std::memcpy(sums->data(), made.sums.data(), made.sums.size() * sizeof(int32_t));
    std::copy(made.scales.begin(), made.scales.end(), scales->data());
  }
  baker::ReducedNetwork view() {
    return {packed.view(),
            {reinterpret_cast<const int8_t*>(weights->data()), reinterpret_cast<const int32_t*>(sums->data()),
             scales->data()},
            kernels};
  }
  void step() {
    const size_t width = layers.front().inputs, stride = simd::pad_to_block(width);
    test::Floats z = test::random_rows(random, nodes, width, stride, 1);
    const tissue::Graph rows{nodes, graph.rows.data(), graph.columns.data(), graph.values.data()};
    network_step(view(), rows, z.data(), nullptr, state->data(), scratch->data());
    test::Rows x;
    for (size_t n = 0; n < nodes; ++n) x.insert(x.end(), &z[n * stride], &z[n * stride] + width);
    test::reference_step(layers, graph, packed.record(), x, nullptr, &reference);
  }
  const float* output() { return last_state(view(), nodes, state->data()).y; }
  double output_difference() {
    double worst = 0;
    for (size_t k = 0; k < nodes * size_t{3}; ++k) {
      const double off = std::fabs(output()[k / 3 * 16 + k % 3] - reference.back().y[k]);
      if (!std::isfinite(off)) FAIL("not finite: node " << k / 3);
      worst = std::max(worst, off);
    }
    return worst;
  }

  std::mt19937 random;
  test::TestGraph graph;
  std::vector<test::PlainLayer> layers;
  test::PackedNetwork packed;
  std::unique_ptr<test::Floats> weights, sums, scales, state, scratch;
  const baker::LayerKernels* kernels = nullptr;
  std::vector<test::PlainState> reference;
  uint32_t nodes;
};

}  // namespace

TEST_CASE("int8_step_stays_near_the_equations_for_partial_ranges_tiles_and_blocks") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const bool has_self : {false, true}) {
      for (const uint32_t nodes : {2u, 7u, simd::kRangeNodes, simd::kRangeNodes + 7}) {
        for (const size_t width : {1u, 17u, 80u}) {
          INFO(nodes << " nodes, " << width << " channels, self weights " << has_self);
          Int8Twins twins(nodes, {9, width, width, 3}, has_self);
          for (int step = 0; step < 12; ++step) twins.step();
          CHECK(twins.output_difference() <= kInt8RollOut);
        }
      }
    }
  });
}

// With dot products of bytes and without.
TEST_CASE("int8_step_has_the_same_bits_on_all_targets_with_fma") {
  test::for_every_isa([&](const char*, const simd::Kernels& of_floats) {
    for (const baker::LayerKernels* kernels : baker::layer_kernels()) {
      Int8Twins twins(55, {21, 40, 64, 33, 3}, true);
      twins.kernels = kernels;
      for (int step = 0; step < 12; ++step) twins.step();
      const std::vector<float> state = twins.state->copy();
      CHECK((!of_floats.fused || core::hash64(std::as_bytes(std::span(state))) == 0x3d4d47bc8869b45a));
      CHECK(twins.output_difference() <= kInt8RollOut);
    }
  });
}

TEST_CASE("nan_in_any_state_reaches_the_output_of_an_int8_step") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (uint32_t l = 0; l < 2; ++l) {
      for (int plane = 0; plane < 3; ++plane) {
        for (const uint16_t bad : {uint16_t{0x7e00}, uint16_t{0xfc00}}) {
          if (plane == 1 && bad != 0x7e00) continue;  // an infinite cell is clamped
          Int8Twins twins(23, {9, 20, 33, 3}, true);
          twins.step();
          const baker::HalfLayerState layer = hidden_state(twins.view(), 23, l, twins.state->data());
          (plane == 0 ? layer.h : plane == 1 ? layer.c : layer.y)[0] = bad;
          twins.step();
          INFO("layer " << l << ", plane " << plane);
          REQUIRE(std::isnan(twins.output()[0]));
        }
      }
    }
  });
}
