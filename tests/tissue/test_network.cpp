// test_network.cpp  One step and many, against the equations in double, for every wiring, size and
// instruction set.
#include "core/half.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/tissue/reference_network.hpp"

using namespace sinew;

namespace {

// Twelve steps through three layers with sums of up to 150 terms of order one: measured 2e-6, room for
// another seed.
constexpr double kRollOut = 1e-5;

// The same with hidden states kept as halves: each step rounds P y, sums of up to 12 cells where nothing
// leaks, by up to 2^-9, and what follows hears it: measured 7e-3.
constexpr double kHalfRollOut = 2e-2;

struct Wiring {
  const char* name;
  bool has_self, has_carry;
  float output_scale, output_leak, hidden_leak, state_clamp;
};

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr Wiring kWirings[] = {
    {"the paper's", false, true, 1, 0, 0, kNone},         {"self weights", true, false, 1, 0, 0, kNone},
    {"leaks", false, false, 1, 0.1f, 0.2f, kNone},        {"clamp", false, false, 1, 0, 0.2f, 0.25f},
    {"as shipped", true, false, 0.3f, 0.05f, 0.2f, 0.5f},
};

// A network, its state and scratch, and the same in double, fed the same numbers.
struct Twins {
  Twins(const Wiring& wiring, uint32_t nodes, const std::vector<size_t>& widths,
        pack::Precision precision = pack::Precision::kFloat32)
      : random(nodes),
        graph(test::ring_with_chords(nodes)),
        layers(make_layers(wiring, widths)),
        packed(record_of(wiring, precision), layers),
        state(tissue::state_floats(packed.view(), nodes)),
        scratch(tissue::scratch_floats(packed.view(), nodes), kStale),
        carry(wiring.has_carry ? nodes * 3 : 0),
        nodes(nodes) {
    for (const test::PlainLayer& layer : layers) {
      const test::Rows zero(nodes * layer.channels, 0.0);
      reference.push_back({zero, zero, zero});
    }
  }
  static constexpr float kStale =
      1e30f;  // what an earlier step of another network may have left in the scratch
  static pack::NetworkRecord record_of(const Wiring& wiring, pack::Precision precision) {
    pack::NetworkRecord record = test::plain_record();
    record.precision = precision;
    record.output_scale = wiring.output_scale;
    record.output_leak = wiring.output_leak;
    record.hidden_leak = wiring.hidden_leak;
    record.state_clamp = wiring.state_clamp;
    return record;
  }
  std::vector<test::PlainLayer> make_layers(const Wiring& wiring, const std::vector<size_t>& widths) {
    std::vector<test::PlainLayer> out;
    for (size_t l = 0; l + 1 < widths.size(); ++l) {
      out.push_back(test::random_layer(random, widths[l], widths[l + 1], wiring.has_self));
    }
    return out;
  }
  void step() {
    const size_t width = layers.front().inputs, stride = simd::pad_to_block(width);
    test::Floats z = test::random_rows(random, nodes, width, stride, 1);
    for (float& value : carry) value = test::uniform(random, -0.1f, 0.1f);
    const float* given = carry.empty() ? nullptr : carry.data();
    const tissue::Graph view{nodes, graph.rows.data(), graph.columns.data(), graph.values.data()};
    tissue::network_step(packed.view(), view, z.data(), given, state.data(), scratch.data());
    test::Rows x;
    for (size_t n = 0; n < nodes; ++n) x.insert(x.end(), &z[n * stride], &z[n * stride] + width);
    test::reference_step(layers, graph, packed.record(), x, given, &reference);
  }
  // Largest difference over all states, of a hidden layer P y; padding must be zero.
  double difference() {
    double worst = 0;
    for (uint32_t l = 0; l < layers.size(); ++l) {
      worst = std::max(
          worst, tissue::keeps_halves(packed.view(), l)
                     ? layer_difference(tissue::half_layer_state(packed.view(), nodes, l, state.data()), l)
                     : layer_difference(tissue::layer_state(packed.view(), nodes, l, state.data()), l));
    }
    return worst;
  }
  template <class Planes>
  double layer_difference(const Planes& have, uint32_t l) {
    const test::PlainState& want = reference[l];
    const bool is_last = l + 1 == layers.size();
    const test::Rows y = is_last ? want.y : test::aggregated(graph, want.y, layers[l].channels);
    return std::max({plane_difference(have.h, want.h, l), plane_difference(have.c, want.c, l),
                     plane_difference(have.y, y, l)});
  }
  static double value_of(float value) { return value; }
  static double value_of(uint16_t half) { return core::half_to_float(half); }
  template <class T>
  double plane_difference(const T* have, const test::Rows& want, uint32_t l) {
    const size_t f = layers[l].channels, padded = simd::pad_to_block(f);
    double worst = 0;
    for (size_t n = 0; n < nodes; ++n) {
      for (size_t j = 0; j < padded; ++j) {
        const double exact = j < f ? want[n * f + j] : 0;
        const double off = std::fabs(value_of(have[n * padded + j]) - exact);
        if (!std::isfinite(off)) FAIL("not finite: node " << n);
        worst = std::max(worst, off);
        if (j >= f) REQUIRE(have[n * padded + j] == 0);
      }
    }
    return worst;
  }

  std::mt19937 random;
  test::TestGraph graph;
  std::vector<test::PlainLayer> layers;
  test::PackedNetwork packed;
  test::Floats state, scratch;
  std::vector<float> carry;
  std::vector<test::PlainState> reference;
  uint32_t nodes;
};

}  // namespace

TEST_CASE("network_step_matches_the_equations_in_double_for_every_wiring") {
  for (const Wiring& wiring : kWirings) {
    INFO("wiring " << wiring.name);
    test::for_every_isa([&](const char*, const simd::Kernels&) {
      Twins twins(wiring, 23, {9, 20, 33, 3});
      for (int step = 0; step < 12; ++step) twins.step();
      CHECK(twins.difference() <= kRollOut);
    });
  }
}

TEST_CASE("network_step_matches_the_equations_for_partial_tiles_and_blocks") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (uint32_t nodes = 2; nodes <= 14; ++nodes) {
      for (const size_t width : {1u, 15u, 16u, 17u, 48u, 64u, 80u}) {
        Twins twins(kWirings[4], nodes, {width, width, 3});
        for (int step = 0; step < 2; ++step) twins.step();
        CHECK(twins.difference() <= kRollOut);
      }
    }
  });
}

TEST_CASE("network_step_matches_the_equations_across_ranges_of_nodes") {
  constexpr uint32_t kRange = simd::kRangeNodes;
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const uint32_t nodes : {kRange - 1, kRange, kRange + 1, 2 * kRange + 7}) {
      Twins twins(kWirings[4], nodes, {9, 20, 80, 3});
      for (int step = 0; step < 3; ++step) twins.step();
      CHECK(twins.difference() <= kRollOut);
    }
  });
}

TEST_CASE("network_step_has_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0xac2dcc33edf0bc9d, [&](const simd::Kernels&) {
    Twins twins(kWirings[4], 23, {21, 40, 64, 3});
    for (int step = 0; step < 12; ++step) twins.step();
    return twins.state.copy();
  });
}

TEST_CASE("states_kept_as_halves_match_the_equations_for_every_wiring_and_partial_sizes") {
  constexpr auto kHalves = pack::Precision::kHalfStates;
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const Wiring& wiring : kWirings) {
      INFO("wiring " << wiring.name);
      Twins twins(wiring, 23, {9, 20, 33, 3}, kHalves);
      for (int step = 0; step < 12; ++step) twins.step();
      CHECK(twins.difference() <= kHalfRollOut);
    }
    for (const uint32_t nodes : {2u, 5u, simd::kRangeNodes, simd::kRangeNodes + 1}) {
      for (const size_t width : {1u, 16u, 17u, 48u}) {
        Twins twins(kWirings[4], nodes, {width, width, width, 3}, kHalves);
        for (int step = 0; step < 3; ++step) twins.step();
        CHECK(twins.difference() <= kHalfRollOut);
      }
    }
  });
}

TEST_CASE("states_kept_as_halves_have_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0x8dc074d060d744c6, [&](const simd::Kernels&) {
    Twins twins(kWirings[4], 23, {21, 40, 64, 3}, pack::Precision::kHalfStates);
    for (int step = 0; step < 12; ++step) twins.step();
    return twins.state.copy();
  });
}

TEST_CASE("states_of_hidden_layers_kept_as_halves_take_half_the_memory") {
  Twins floats(kWirings[4], 32, {9, 32, 48, 3}),
      halves(kWirings[4], 32, {9, 32, 48, 3}, pack::Precision::kHalfStates);
  CHECK(floats.state.size() == 32 * 3 * (32 + 48 + 16));
  CHECK(halves.state.size() == 32 * 3 * (16 + 24 + 16));
}

TEST_CASE("cells_never_leave_the_clamp_and_largest_cell_says_how_far_they_go") {
  Twins twins(kWirings[3], 23, {9, 20, 33, 3});
  for (int step = 0; step < 12; ++step) twins.step();
  REQUIRE(tissue::largest_cell(twins.packed.view(), 23, twins.state.data()) == 0.25f);
  tissue::layer_state(twins.packed.view(), 23, 1, twins.state.data()).c[40] = -7;
  REQUIRE(tissue::largest_cell(twins.packed.view(), 23, twins.state.data()) == 7);
  tissue::layer_state(twins.packed.view(), 23, 0, twins.state.data()).c[0] = NAN;
  REQUIRE(std::isnan(tissue::largest_cell(twins.packed.view(), 23, twins.state.data())));

  Twins halves(kWirings[3], 23, {9, 20, 33, 3}, pack::Precision::kHalfStates);
  for (int step = 0; step < 12; ++step) halves.step();
  REQUIRE(tissue::largest_cell(halves.packed.view(), 23, halves.state.data()) == 0.25f);
  uint16_t* c = tissue::half_layer_state(halves.packed.view(), 23, 1, halves.state.data()).c;
  c[40] = 0xc700;
  REQUIRE(tissue::largest_cell(halves.packed.view(), 23, halves.state.data()) == 7);
  c[0] = 0xfe00;
  REQUIRE(std::isnan(tissue::largest_cell(halves.packed.view(), 23, halves.state.data())));
}

TEST_CASE("nan_in_any_state_reaches_the_output_in_the_same_step") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (uint32_t l = 0; l < 3; ++l) {
      for (int plane = 0; plane < 3; ++plane) {
        Twins twins(kWirings[4], 23, {9, 20, 33, 3});
        twins.step();
        const tissue::LayerState layer = tissue::layer_state(twins.packed.view(), 23, l, twins.state.data());
        (plane == 0 ? layer.h : plane == 1 ? layer.c : layer.y)[0] = NAN;
        twins.step();
        REQUIRE(std::isnan(tissue::layer_state(twins.packed.view(), 23, 2, twins.state.data()).y[0]));
      }
    }
  });
}
