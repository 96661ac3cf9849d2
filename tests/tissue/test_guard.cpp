// test_guard.cpp  Every guard fires once, and does not fire without cause.
#include "tissue/guard.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/tissue/reference_network.hpp"

using namespace sinew;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr uint32_t kNodes = 7;
constexpr float kUnit = 0.1f, kLimit = 0.05f;
constexpr float kRounding = 1e-7f;  // of 0.05 m through one division and one product

// Two regions of 3 and 4 nodes, the second with twice the limit; states are filled with ones.
struct Fixture {
  Fixture()
      : random(5),
        packed(test::plain_record(),
               {test::random_layer(random, 9, 20, false), test::random_layer(random, 20, 3, false)}),
        state(tissue::state_floats(packed.view(), kNodes), 1),
        u(kNodes * 3, 99.0f) {
    packed.record().length_unit_m = kUnit;
    packed.record().state_clamp = 8;
    regions[0].node_count = 3;
    regions[0].displacement_limit_m = kLimit;
    regions[1].first_node = 3;
    regions[1].node_count = 4;
    regions[1].displacement_limit_m = 2 * kLimit;
    for (uint32_t node = 0; node < kNodes; ++node) set_y(node, 0.1f, 0, -0.1f);
  }
  tissue::LayerState layer(uint32_t l) { return tissue::layer_state(packed.view(), kNodes, l, state.data()); }
  float* y(uint32_t node) { return layer(1).y + node * 16; }
  void set_y(uint32_t node, float a, float b, float c) {
    y(node)[0] = a;
    y(node)[1] = b;
    y(node)[2] = c;
  }
  tissue::GuardResult guard() {
    return tissue::guard_step(packed.view(), regions, kNodes, state.data(), u.data());
  }

  std::mt19937 random;
  test::PackedNetwork packed;
  test::Floats state;
  std::vector<float> u;
  pack::RegionRecord regions[2]{};
};

}  // namespace

TEST_CASE("guard_asks_for_a_restart_on_nan_and_infinity_and_writes_no_displacement") {
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (size_t axis = 0; axis < 3; ++axis) {
      Fixture fixture;
      fixture.y(6)[axis] = bad;
      REQUIRE(fixture.guard().restart);
      for (const float value : fixture.u) REQUIRE(value == 99.0f);
    }
  }
}

TEST_CASE("guard_looks_at_every_cell_when_cells_are_not_bounded") {
  Fixture fixture;
  fixture.packed.record().state_clamp = kInfinity;
  REQUIRE(!fixture.guard().restart);
  fixture.layer(0).c[4 * 32 + 19] = kInfinity;
  REQUIRE(fixture.guard().restart);
}

TEST_CASE("guard_converts_to_metres_and_leaves_what_is_within_the_limit_alone") {
  Fixture fixture;
  const std::vector<float> before = fixture.state.copy();
  const tissue::GuardResult result = fixture.guard();
  REQUIRE((result.displacement_clamps == 0 && !result.restart));
  for (uint32_t node = 0; node < kNodes; ++node) {
    REQUIRE(fixture.u[node * 3] == Approx(0.01f));
    REQUIRE(fixture.u[node * 3 + 2] == Approx(-0.01f));
  }
  REQUIRE(fixture.state.copy() == before);
}

TEST_CASE("guard_holds_a_node_at_its_regions_limit_and_forgets_what_pushed_it") {
  Fixture fixture;
  fixture.set_y(1, 0, 3, 4);         // 0.5 m: ten times the limit
  fixture.set_y(5, 0, 0.45f, 0.6f);  // 0.075 m: beyond the first region's limit, within its own
  const tissue::GuardResult result = fixture.guard();
  REQUIRE((result.displacement_clamps == 1 && !result.restart));
  REQUIRE(fixture.u[3] == 0);
  REQUIRE(fixture.u[4] == Approx(0.6f * kLimit).margin(kRounding));
  REQUIRE(fixture.u[5] == Approx(0.8f * kLimit).margin(kRounding));
  REQUIRE(fixture.u[16] == Approx(0.045f).margin(kRounding));
  for (int axis = 0; axis < 3; ++axis)
    REQUIRE(fixture.y(1)[axis] * kUnit == Approx(fixture.u[3 + static_cast<size_t>(axis)]));
  for (uint32_t l = 0; l < 2; ++l) {
    const uint32_t padded = l == 0 ? 32 : 16;
    const tissue::LayerState layer = fixture.layer(l);
    for (uint32_t i = 0; i < kNodes * padded; ++i) {
      const float want = i / padded == 1 ? 0.0f : 1.0f;
      REQUIRE((layer.h[i] == want && layer.c[i] == want));
      if (l == 0) REQUIRE(layer.y[i] == want);
    }
  }
}

TEST_CASE("guard_holds_a_node_whose_square_overflows") {
  Fixture fixture;
  fixture.set_y(0, 1e30f, 0, 0);
  REQUIRE(fixture.guard().displacement_clamps == 1);
  REQUIRE(fixture.u[0] == Approx(kLimit).margin(kRounding));
}

TEST_CASE("rebase_state_stands_at_the_displacement_with_no_memory") {
  Fixture fixture;
  std::vector<float> wanted(kNodes * 3);
  for (size_t i = 0; i < wanted.size(); ++i) wanted[i] = 0.001f * static_cast<float>(i);
  tissue::rebase_state(fixture.packed.view(), kNodes, wanted.data(), fixture.state.data());
  REQUIRE(fixture.guard().displacement_clamps == 0);
  for (size_t i = 0; i < wanted.size(); ++i) REQUIRE(fixture.u[i] == Approx(wanted[i]).margin(kRounding));
  for (uint32_t node = 0; node < kNodes; ++node) std::fill_n(fixture.y(node), 3, 0.0f);
  for (const float value : fixture.state.copy()) REQUIRE(value == 0);
}
