// halves.cpp  Networks whose hidden states are kept as halves, against the equations in double.
#include "tests/baker/precision/reduced_twins.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using test::kWirings, test::Wiring;

namespace {

using Twins = test::Twins<baker::ReducedNetwork>;

constexpr auto kHalves = pack::Precision::kHalfStates;

// Three layers and twelve steps with sums of up to 150 terms of order one: each step rounds P y, sums of up
// to 12 cells where nothing leaks, by up to 2^-9, and what follows hears it: measured 7e-3.
constexpr double kHalfRollOut = 2e-2;

}  // namespace

TEST_CASE("states_kept_as_halves_match_the_equations_for_every_wiring_and_partial_sizes") {
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
    Twins twins(kWirings[4], 23, {21, 40, 64, 3}, kHalves);
    for (int step = 0; step < 12; ++step) twins.step();
    return twins.state.copy();
  });
}

TEST_CASE("states_of_hidden_layers_kept_as_halves_take_half_the_memory") {
  Twins halves(kWirings[4], 32, {9, 32, 48, 3}, kHalves);
  CHECK(halves.state.size() == 32 * 3 * (16 + 24 + 16));  // of floats 32 + 48 + 16
}
