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
  uint32_t hold(bool with_network = true) {
    tissue::NodeMemory memory;
    if (with_network) memory = {&network, kNodes, state.data()};
    uint32_t held = 0;
    for (const pack::RegionRecord& region : regions) {
      const size_t at = size_t{3} * region.first_node;
      held += tissue::hold_at_limit(region, memory, l.data() + at, l_before.data() + at);
    }
    return held;
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

TEST_CASE("what_is_within_the_limit_is_left_alone") {
  Fixture fixture;
  const std::vector<float> state = fixture.state.copy(), l = fixture.l, before = fixture.l_before;
  CHECK(fixture.hold() == 0);
  CHECK(fixture.state.copy() == state);
  CHECK(fixture.l == l);
  CHECK(fixture.l_before == before);
}

TEST_CASE("guard_holds_a_node_at_its_regions_limit_and_forgets_what_pushed_it") {
  Fixture fixture;
  fixture.set_l(1, 0, 0.3f, 0.4f);     // ten times the limit
  fixture.set_l(5, 0, 0.045f, 0.06f);  // beyond the first region's limit, within its own
  CHECK(fixture.hold() == 1);
  CHECK(fixture.l[3] == 0);
  CHECK(fixture.l[4] == Approx(0.6f * kLimit).margin(kRounding));
  CHECK(fixture.l[5] == Approx(0.8f * kLimit).margin(kRounding));
  CHECK(fixture.l[16] == 0.045f);
  for (size_t axis = 0; axis < 3; ++axis) {
    CHECK(fixture.l_before[3 + axis] == fixture.l[3 + axis]);  // no velocity
    CHECK(fixture.l_before[axis] == 0.5f);
    CHECK(fixture.y(1)[axis] * kUnit == Approx(fixture.l[3 + axis]));
  }
  for (uint32_t at = 0; at < 2; ++at) {
    const uint32_t padded = at == 0 ? 32 : 16;
    const tissue::LayerState layer = fixture.layer(at);
    for (uint32_t i = 0; i < kNodes * padded; ++i) {
      const float want = i / padded == 1 ? 0.0f : 1.0f;
      REQUIRE((layer.h[i] == want && layer.c[i] == want));
      if (at == 0) REQUIRE(layer.y[i] == want);
    }
  }
}

// The hidden layer's planes are halves: the node's are zero, its neighbours' and the planes' ends untouched.
TEST_CASE("guard_forgets_the_halves_of_a_node_and_no_others") {
  for (const pack::Precision precision : {pack::Precision::kHalfStates, pack::Precision::kInt8}) {
    Fixture fixture(precision);
    constexpr uint32_t kPadded = 32, kHeld = 1;
    constexpr uint16_t kOne = 0x3c00;
    const tissue::HalfLayerState halves =
        tissue::half_layer_state(fixture.network, kNodes, 0, fixture.state.data());
    for (uint16_t* plane : {halves.h, halves.c, halves.y}) std::fill_n(plane, kNodes * kPadded, kOne);
    fixture.set_l(kHeld, 0, 0.3f, 0.4f);
    CHECK(fixture.hold() == 1);
    for (const uint16_t* plane : {halves.h, halves.c, halves.y}) {
      for (uint32_t i = 0; i < kNodes * kPadded; ++i) REQUIRE(plane[i] == (i / kPadded == kHeld ? 0 : kOne));
    }
    for (uint32_t i = 0; i < kNodes * 16; ++i)
      REQUIRE(fixture.layer(1).c[i] == (i / 16 == kHeld ? 0.0f : 1.0f));
    CHECK(fixture.y(kHeld)[2] * kUnit == Approx(0.8f * kLimit));
  }
}

TEST_CASE("without_a_network_a_node_is_held_all_the_same") {
  Fixture fixture;
  fixture.set_l(4, 1, 0, 0);
  const std::vector<float> state = fixture.state.copy();
  CHECK(fixture.hold(false) == 1);
  CHECK(fixture.l[12] == Approx(2 * kLimit).margin(kRounding));
  CHECK(fixture.state.copy() == state);
}

TEST_CASE("a_base_beyond_the_limit_is_scaled_as_a_whole_and_stops") {
  Fixture fixture;
  fixture.set_l(4, 0.06f, 0, 0.08f);  // 0.1 m, the limit of the second region
  float q[2] = {1, -2}, q_before[2] = {5, 6};
  std::vector<float> r(12, 0.02f), r_before(12, 1.0f);
  const auto hold = [&] {
    return tissue::hold_base_at_limit(fixture.regions[1], 2, fixture.l.data() + 9, {q, q_before},
                                      {r.data(), r_before.data()});
  };
  CHECK(hold() == 0);
  CHECK((q[0] == 1 && q_before[0] == 5));
  fixture.set_l(4, 0.12f, 0, 0.16f);
  CHECK(hold() == 1);
  CHECK(fixture.l[12] == Approx(0.06f));
  CHECK(fixture.l[9] == Approx(0.005f));
  CHECK((q[0] == Approx(0.5f) && q[1] == Approx(-1)));
  CHECK((q_before[0] == q[0] && q_before[1] == q[1]));
  for (size_t i = 0; i < 12; ++i) CHECK((r[i] == Approx(0.01f) && r_before[i] == r[i]));
}

TEST_CASE("guard_holds_a_node_whose_square_overflows") {
  Fixture fixture;
  fixture.set_l(0, 1e30f, 0, 0);
  CHECK(fixture.hold() == 1);
  CHECK(fixture.l[0] == Approx(kLimit).margin(kRounding));
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

TEST_CASE("rebase_state_keeps_no_memory_and_write_output_all_of_it") {
  Fixture fixture;
  tissue::write_output(fixture.network, fixture.regions, kNodes, fixture.l.data(), fixture.state.data());
  CHECK(fixture.layer(0).h[3] == 1);
  tissue::rebase_state(fixture.network, fixture.regions, kNodes, fixture.l.data(), fixture.state.data());
  for (uint32_t node = 0; node < kNodes; ++node) std::fill_n(fixture.y(node), 3, 0.0f);
  for (const float value : fixture.state.copy()) REQUIRE(value == 0);
}
