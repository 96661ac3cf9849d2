// test_network.cpp  One step and many, against the equations in double, for every wiring, size and
// instruction set.
#include "tests/simd/every_isa.hpp"
#include "tests/tissue/network_twins.hpp"

using namespace sinew;
using test::kWirings, test::Wiring;

namespace {

using Twins = test::Twins<tissue::Network>;

// Twelve steps through three layers with sums of up to 150 terms of order one: measured 2e-6, room for
// another seed.
constexpr double kRollOut = 1e-5;

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

TEST_CASE("cells_never_leave_the_clamp_and_largest_cell_says_how_far_they_go") {
  Twins twins(kWirings[3], 23, {9, 20, 33, 3});
  for (int step = 0; step < 12; ++step) twins.step();
  REQUIRE(tissue::largest_cell(twins.view(), 23, twins.state.data()) == 0.25f);
  tissue::layer_state(twins.view(), 23, 1, twins.state.data()).c[40] = -7;
  REQUIRE(tissue::largest_cell(twins.view(), 23, twins.state.data()) == 7);
  tissue::layer_state(twins.view(), 23, 0, twins.state.data()).c[0] = NAN;
  REQUIRE(std::isnan(tissue::largest_cell(twins.view(), 23, twins.state.data())));
}

TEST_CASE("nan_in_any_state_reaches_the_output_in_the_same_step") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (uint32_t l = 0; l < 3; ++l) {
      for (int plane = 0; plane < 3; ++plane) {
        Twins twins(kWirings[4], 23, {9, 20, 33, 3});
        twins.step();
        const tissue::LayerState layer = tissue::layer_state(twins.view(), 23, l, twins.state.data());
        (plane == 0 ? layer.h : plane == 1 ? layer.c : layer.y)[0] = NAN;
        twins.step();
        REQUIRE(std::isnan(tissue::layer_state(twins.view(), 23, 2, twins.state.data()).y[0]));
      }
    }
  });
}
