// test_guard.cpp  Every guard fires once, and does not fire without cause.
#include "tissue/modes/guard.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/tissue/reference_network.hpp"

using namespace sinew;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr uint32_t kNodes = 7;
constexpr float kUnit = 0.1f, kLimit = 0.05f;
constexpr float kRounding = 1e-7f;  // of 0.05 m through one division and one product

// Two regions of 3 and 4 nodes, the second with twice the limit and half the radius; states are filled with
// ones, l with 0.01 0 -0.01 m.
struct Fixture {
  explicit Fixture(pack::Precision precision = pack::Precision::kFloat32)
      : random(5),
        packed(of_precision(precision),
               {test::random_layer(random, 9, 20, false), test::random_layer(random, 20, 3, false)}),
        network(packed.view()),
        state(tissue::state_floats(network, kNodes), 1) {
    packed.record().length_unit = kUnit;
    packed.record().state_clamp = 8;
    regions[0].node_count = 3;
    regions[0].radius_m = 1;
    regions[0].displacement_limit_m = kLimit;
    regions[1].first_node = 3;
    regions[1].node_count = 4;
    regions[1].radius_m = 0.5f;
    regions[1].displacement_limit_m = 2 * kLimit;
    for (uint32_t node = 0; node < kNodes; ++node) set_l(node, 0.01f, 0, -0.01f);
  }
  static pack::NetworkRecord of_precision(pack::Precision precision) {
    pack::NetworkRecord record = test::plain_record();
    record.precision = precision;
    return record;
  }
  tissue::LayerState layer(uint32_t at) { return tissue::layer_state(network, kNodes, at, state.data()); }
  float* y(uint32_t node) { return layer(1).y + node * 16; }
  void set_l(uint32_t node, float a, float b, float c) {
    l[node * 3] = a;
    l[node * 3 + 1] = b;
    l[node * 3 + 2] = c;
  }
  bool finite() { return tissue::network_is_finite(network, kNodes, state.data()); }

  std::mt19937 random;
  test::PackedNetwork packed;
  tissue::Network network;
  test::Floats state;
  std::vector<float> l = std::vector<float>(kNodes * 3), l_before = std::vector<float>(kNodes * 3, 0.5f);
  pack::RegionRecord regions[2]{};
};

}  // namespace

TEST_CASE("one_number_that_is_not_finite_is_seen") {
  std::vector<float> values(37, 1e38f);
  CHECK(tissue::all_finite(values.data(), values.size()));
  CHECK(tissue::all_finite(values.data(), 0));
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (const size_t at : {0u, 17u, 36u}) {
      std::vector<float> damaged = values;
      damaged[at] = bad;
      CHECK_FALSE(tissue::all_finite(damaged.data(), damaged.size()));
    }
  }
}

TEST_CASE("a_network_whose_output_is_not_finite_is_seen") {
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (size_t axis = 0; axis < 3; ++axis) {
      Fixture fixture;
      CHECK(fixture.finite());
      fixture.y(6)[axis] = bad;
      CHECK_FALSE(fixture.finite());
    }
  }
}

TEST_CASE("guard_looks_at_every_cell_when_cells_are_not_bounded") {
  Fixture fixture;
  fixture.packed.record().state_clamp = kInfinity;
  REQUIRE(fixture.finite());
  fixture.layer(0).c[4 * 32 + 19] = kInfinity;
  REQUIRE_FALSE(fixture.finite());
}

TEST_CASE("a_displacement_within_the_free_share_of_its_limit_is_left_alone") {
  CHECK(tissue::limit_share(0, kLimit) == 1);
  CHECK(tissue::limit_share(tissue::kFreeShare * kLimit, kLimit) == 1);
  CHECK(tissue::limit_share(kNan, kLimit) == 1);  // what is not finite has its own guard
}

TEST_CASE("a_displacement_approaches_its_limit_smoothly_and_never_reaches_beyond") {
  float before = 0, slope_before = 1;
  for (int i = 1; i <= 400; ++i) {
    const float asked = 0.01f * static_cast<float>(i) * kLimit;
    const float shown = asked * tissue::limit_share(asked, kLimit),
                slope = (shown - before) / (0.01f * kLimit);
    CHECK(shown >= before - 1e-6f * kLimit);
    CHECK(shown <= kLimit * (1 + kRounding));
    CHECK(std::abs(slope - slope_before) < 0.025f);  // the second derivative of tanh, a hundredth apart
    before = shown;
    slope_before = slope;
  }
  for (const float wild : {1e10f, 1e30f}) CHECK(wild * tissue::limit_share(wild, kLimit) == Approx(kLimit));
}

TEST_CASE("the_largest_displacement_is_found_even_where_its_square_overflows") {
  Fixture fixture;
  CHECK(tissue::largest_displacement_m(fixture.l.data(), kNodes) == Approx(std::sqrt(2.0) * 0.01));
  fixture.set_l(3, 0, 3e30f, 4e30f);
  CHECK(tissue::largest_displacement_m(fixture.l.data(), kNodes) == Approx(5e30f));
}

TEST_CASE("output_is_told_in_shares_of_each_region_s_radius") {
  Fixture fixture;
  std::vector<float> wanted(kNodes * 3), read(kNodes * 3);
  for (size_t i = 0; i < wanted.size(); ++i) wanted[i] = 0.001f * static_cast<float>(i);
  tissue::rebase_state(fixture.network, fixture.regions, kNodes, wanted.data(), fixture.state.data());
  CHECK(fixture.y(1)[0] == Approx(wanted[3] / kUnit));
  CHECK(fixture.y(4)[0] == Approx(wanted[12] / (0.5f * kUnit)));
  tissue::read_output(fixture.network, fixture.regions, kNodes, fixture.state.data(), read.data());
  for (size_t i = 0; i < wanted.size(); ++i) CHECK(read[i] == Approx(wanted[i]).margin(kRounding));
}

TEST_CASE("what_is_beyond_a_limit_is_shown_and_remembered_by_the_same_share_and_swings_on_whole") {
  Fixture fixture;
  const float wild_m = 3 * kLimit;
  fixture.set_l(1, wild_m, 0, 0);
  const std::vector<float> whole = fixture.l;
  const float share = tissue::limit_share(wild_m, kLimit);
  REQUIRE(share < 0.5f);

  std::vector<float> shown = fixture.l;
  tissue::hold_within(kLimit, 3, shown.data());
  CHECK(shown[3] == Approx(share * wild_m));
  CHECK(shown[0] == Approx(share * whole[0]));  // the region as one
  CHECK(shown[9] == whole[9]);                  // the other region is its own

  tissue::write_output(fixture.network, fixture.regions, kNodes, fixture.l.data(), fixture.state.data());
  CHECK(fixture.l == whole);
  CHECK(fixture.y(1)[0] == Approx(share * wild_m / kUnit));
  CHECK(fixture.y(3)[0] == Approx(whole[9] / (0.5f * kUnit)));

  // A step starts from all of it, whatever is remembered.
  std::vector<float> carry(9);
  tissue::carry_to(fixture.network, fixture.regions[0], kNodes, fixture.l.data(), fixture.state.data(),
                   carry.data());
  CHECK(carry[3] == Approx((1 - share) * wild_m / kUnit));
}

TEST_CASE("rebase_state_keeps_no_memory_and_write_output_all_of_it") {
  Fixture fixture;
  tissue::write_output(fixture.network, fixture.regions, kNodes, fixture.l.data(), fixture.state.data());
  CHECK(fixture.layer(0).h[3] == 1);
  tissue::rebase_state(fixture.network, fixture.regions, kNodes, fixture.l.data(), fixture.state.data());
  for (uint32_t node = 0; node < kNodes; ++node) std::fill_n(fixture.y(node), 3, 0.0f);
  for (const float value : fixture.state.copy()) REQUIRE(value == 0);
}
