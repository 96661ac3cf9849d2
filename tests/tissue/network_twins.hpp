// network_twins.hpp  A network in some precision and the same in double, fed the same numbers.
#pragma once
#include <catch2/catch.hpp>

#include "tests/tissue/reference_network.hpp"

namespace sinew::tissue {

inline LayerState values_of(const Network& network, uint32_t nodes, uint32_t layer, float* state) {
  return layer_state(network, nodes, layer, state);
}

}  // namespace sinew::tissue

namespace sinew::test {

struct Wiring {
  const char* name;
  bool has_self, has_carry;
  float output_scale, output_leak, hidden_leak, state_clamp;
};

inline constexpr float kNone = std::numeric_limits<float>::infinity();
inline constexpr Wiring kWirings[] = {
    {"the paper's", false, true, 1, 0, 0, kNone},         {"self weights", true, false, 1, 0, 0, kNone},
    {"leaks", false, false, 1, 0.1f, 0.2f, kNone},        {"clamp", false, false, 1, 0, 0.2f, 0.25f},
    {"as shipped", true, false, 0.3f, 0.05f, 0.2f, 0.5f},
};

// A network, its state and scratch, and the same in double, fed the same numbers.
// Network: tissue::Network, or one made of it that has functions of the same names.
template <class Network>
struct Twins {
  Twins(const Wiring& wiring, uint32_t nodes, const std::vector<size_t>& widths,
        pack::Precision precision = pack::Precision::kFloat32)
      : random(nodes),
        graph(ring_with_chords(nodes)),
        layers(make_layers(wiring, widths)),
        packed(record_of(wiring, precision), layers),
        state(state_floats(view(), nodes)),
        scratch(scratch_floats(view(), nodes), kStale),
        carry(wiring.has_carry ? nodes * 3 : 0),
        nodes(nodes) {
    for (const PlainLayer& layer : layers) {
      const Rows zero(nodes * layer.channels, 0.0);
      reference.push_back({zero, zero, zero});
    }
  }
  static constexpr float kStale =
      1e30f;  // what an earlier step of another network may have left in the scratch
  static pack::NetworkRecord record_of(const Wiring& wiring, pack::Precision precision) {
    pack::NetworkRecord record = plain_record();
    record.precision = precision;
    record.output_scale = wiring.output_scale;
    record.output_leak = wiring.output_leak;
    record.hidden_leak = wiring.hidden_leak;
    record.state_clamp = wiring.state_clamp;
    return record;
  }
  std::vector<PlainLayer> make_layers(const Wiring& wiring, const std::vector<size_t>& widths) {
    std::vector<PlainLayer> out;
    for (size_t l = 0; l + 1 < widths.size(); ++l) {
      out.push_back(random_layer(random, widths[l], widths[l + 1], wiring.has_self));
    }
    return out;
  }
  void step() {
    const size_t width = layers.front().inputs, stride = simd::pad_to_block(width);
    Floats z = random_rows(random, nodes, width, stride, 1);
    for (float& value : carry) value = uniform(random, -0.1f, 0.1f);
    const float* given = carry.empty() ? nullptr : carry.data();
    const tissue::Graph rows{nodes, graph.rows.data(), graph.columns.data(), graph.values.data()};
    network_step(view(), rows, z.data(), given, state.data(), scratch.data());
    Rows x;
    for (size_t n = 0; n < nodes; ++n) x.insert(x.end(), &z[n * stride], &z[n * stride] + width);
    reference_step(layers, graph, packed.record(), x, given, &reference);
  }
  Network view() { return {packed.view()}; }
  // Largest difference over all states, of a hidden layer P y; padding must be zero.
  double difference() {
    double worst = 0;
    for (uint32_t l = 0; l < layers.size(); ++l)
      worst = std::max(worst, layer_difference(values_of(view(), nodes, l, state.data()), l));
    return worst;
  }
  template <class Planes>
  double layer_difference(const Planes& have, uint32_t l) {
    const PlainState& want = reference[l];
    const bool is_last = l + 1 == layers.size();
    const Rows y = is_last ? want.y : aggregated(graph, want.y, layers[l].channels);
    return std::max({plane_difference(have.h, want.h, l), plane_difference(have.c, want.c, l),
                     plane_difference(have.y, y, l)});
  }
  template <class Plane>
  double plane_difference(const Plane& have, const Rows& want, uint32_t l) {
    const size_t f = layers[l].channels, padded = simd::pad_to_block(f);
    double worst = 0;
    for (size_t n = 0; n < nodes; ++n) {
      for (size_t j = 0; j < padded; ++j) {
        const double exact = j < f ? want[n * f + j] : 0;
        const double off = std::fabs(double{have[n * padded + j]} - exact);
        if (!std::isfinite(off)) FAIL("not finite: node " << n);
        worst = std::max(worst, off);
        if (j >= f) REQUIRE(have[n * padded + j] == 0);
      }
    }
    return worst;
  }

  std::mt19937 random;
  TestGraph graph;
  std::vector<PlainLayer> layers;
  PackedNetwork packed;
  Floats state, scratch;
  std::vector<float> carry;
  std::vector<PlainState> reference;
  uint32_t nodes;
};

}  // namespace sinew::test
