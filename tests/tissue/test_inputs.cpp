// test_inputs.cpp  Order, scales, units, the envelope and its count.
#include "tissue/network/inputs.hpp"

#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <limits>

#include "tests/simd/test_data.hpp"
#include "tests/tissue/reference_network.hpp"
#include "tissue/frames/node_drive.hpp"

using namespace sinew;
using pack::InputKind;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr uint32_t kNodes = 3;

struct Fixture {
  explicit Fixture(std::vector<pack::InputRecord> inputs, uint32_t node_count = kNodes)
      : count(node_count),
        packed(test::plain_record(), {{width_of(inputs),
                                       3,
                                       std::vector<float>(width_of(inputs) * 12),
                                       {},
                                       std::vector<float>(36),
                                       std::vector<float>(27),
                                       std::vector<float>(12)}}) {
    packed.inputs = std::move(inputs);
    packed.record().length_unit = 0.25f;  // half a metre, at this radius
    region.center_m[0] = 1;
    region.center_m[1] = 2;
    region.center_m[2] = 3;
    region.radius_m = 2;
    region.node_count = count;
    for (uint32_t n = 0; n < count; ++n) {
      nodes.push_back({{static_cast<float>(n), 4, 5},
                       {0, static_cast<float>(n), 1},
                       0.25f * static_cast<float>(n),
                       0,
                       {}});
    }
    for (size_t i = 0; i < drive.size(); ++i) drive[i] = static_cast<float>(i);
    for (size_t i = 0; i < l.size(); ++i) {
      l[i] = static_cast<float>(i);
      l_before[i] = 1;
      l_hat[i] = 2 * l[i];
      felt[i] = 100 * l[i];
      theta[i] = -l[i];
    }
  }
  static size_t width_of(const std::vector<pack::InputRecord>& inputs) {
    size_t width = 0;
    for (const pack::InputRecord& input : inputs) {
      const bool scalar = input.kind == InputKind::kStiffness || input.kind == InputKind::kFrequency;
      width += scalar ? 1 : 3;
    }
    return width;
  }
  uint32_t assemble() {
    const tissue::Network network = packed.view();
    test::Floats rows(count * tissue::input_stride(network), 99.0f);
    const uint32_t clamps = tissue::assemble_inputs(network,
                                                    {.region = &region,
                                                     .nodes = nodes.data(),
                                                     .drive = drive.data(),
                                                     .felt = felt.data(),
                                                     .l = l.data(),
                                                     .l_before = l_before.data(),
                                                     .l_hat = l_hat.data(),
                                                     .theta = theta.data(),
                                                     .first_rad_per_s = 20,
                                                     .tick_s = 0.0625f},
                                                    rows.data());
    z = rows.copy();
    return clamps;
  }
  uint32_t count;
  test::PackedNetwork packed;
  pack::RegionRecord region{};
  std::vector<pack::NodeRecord> nodes;
  std::vector<float> drive = std::vector<float>(count * tissue::kNodeDriveWidth);
  std::vector<float> l = std::vector<float>(count * 3), l_before = l, l_hat = l, felt = l, theta = l;
  std::vector<float> z;
};

std::vector<float> row(const Fixture& fixture, size_t node, size_t count) {
  const size_t stride = fixture.z.size() / fixture.count;
  return {fixture.z.begin() + static_cast<long>(node * stride),
          fixture.z.begin() + static_cast<long>(node * stride + count)};
}

}  // namespace

TEST_CASE("assemble_inputs_counts_what_leaves_the_envelope_and_what_is_not_a_number") {
  Fixture fixture({{InputKind::kGravityChange, 0.1f, 1, 0}, {InputKind::kAngularVelocity, 1, kInfinity, 0}});
  std::fill(fixture.drive.begin(), fixture.drive.end(), 0.0f);
  fixture.drive[3] = 10;                                   // exactly on the envelope: not beyond it
  fixture.drive[4] = -10.5f;                               // beyond
  fixture.drive[5] = kNan;                                 // 0
  fixture.drive[6] = 1e30f;                                // not bounded
  fixture.drive[7] = -kInfinity;                           // 0
  fixture.drive[2 * tissue::kNodeDriveWidth + 3] = 1e30f;  // another node
  REQUIRE(fixture.assemble() == 4);
  REQUIRE(row(fixture, 0, 6) == std::vector<float>{1, -1, 0, 1e30f, 0, 0});
  REQUIRE(row(fixture, 2, 3) == std::vector<float>{1, 0, 0});
}

TEST_CASE("assemble_inputs_lays_them_out_in_the_packs_order_with_scale_and_zero_padding") {
  Fixture fixture({{InputKind::kStiffness, 2, kInfinity, 0},
                   {InputKind::kVelocity, 1, kInfinity, 0},
                   {InputKind::kRestPosition, 1, kInfinity, 0},
                   {InputKind::kDisplacement, 10, kInfinity, 0},
                   {InputKind::kRestNormal, -1, kInfinity, 0}});
  REQUIRE(fixture.assemble() == 0);
  // Node 1: l = 3 4 5 m in units of 0.5 m, one metre less the tick before.
  REQUIRE(row(fixture, 1, 16) == std::vector<float>{0.5f, 4, 6, 8, 0, 1, 1, 60, 80, 100, 0, -1, -1, 0, 0, 0});
}

TEST_CASE("assemble_inputs_reads_each_part_of_the_drive_from_its_place") {
  Fixture fixture({{InputKind::kGravityChange, 1, kInfinity, 0},
                   {InputKind::kAngularVelocity, 1, kInfinity, 0},
                   {InputKind::kAngularAcceleration, 1, kInfinity, 0}});
  REQUIRE(fixture.assemble() == 0);
  for (size_t node = 0; node < kNodes; ++node) {
    const std::vector<float> values = row(fixture, node, 9);
    for (size_t k = 0; k < values.size(); ++k)
      REQUIRE(values[k] == static_cast<float>(node * tissue::kNodeDriveWidth + 3 + k));
  }
}

// Node 1: the drive counts up from 15, so its bend is (27, 28, 29) rad; the vectors crossed are those of the
// test below.
TEST_CASE("assemble_inputs_crosses_the_bend_with_force_step_and_displacement") {
  Fixture fixture({{InputKind::kBend, 1, kInfinity, 0},
                   {InputKind::kBentForce, 1, kInfinity, 0},
                   {InputKind::kBentStep, 1, kInfinity, 0},
                   {InputKind::kBentDisplacement, 1, kInfinity, 0}});
  REQUIRE(fixture.assemble() == 0);
  const std::vector<float> values = row(fixture, 1, 12);
  const auto part = [&](size_t k) {
    return Eigen::Vector3f(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
  };
  const Eigen::Vector3f bend(27, 28, 29), l(3, 4, 5);
  CHECK(part(0) == bend);
  CHECK((part(1) - bend.cross(0.5f * l)).norm() < 1e-4f);  // float's rounding of some hundreds
  CHECK((part(2) - bend.cross(2 * l)).norm() < 1e-4f);
  CHECK((part(3) - bend.cross(2 * l)).norm() < 1e-4f);
}

// Node 1: theta is less l, l a metre less the tick before, angular velocity (21, 22, 23) rad/s.
TEST_CASE("assemble_inputs_crosses_the_turn_and_the_angular_velocity_with_what_moves") {
  Fixture fixture({{InputKind::kTurnedForce, 1, kInfinity, 0},
                   {InputKind::kTurnedStep, 1, kInfinity, 0},
                   {InputKind::kTurnedVelocity, 1, kInfinity, 0},
                   {InputKind::kSpunStep, 1, kInfinity, 0},
                   {InputKind::kSpunVelocity, 1, kInfinity, 0}});
  fixture.theta = {0, 0, 0, 0.5f, -1, 2, 0, 0, 0};
  REQUIRE(fixture.assemble() == 0);
  const std::vector<float> values = row(fixture, 1, 15);
  const Eigen::Vector3f theta(0.5f, -1, 2), spin(21, 22, 23), l(3, 4, 5), velocity(4, 6, 8);
  const std::array<Eigen::Vector3f, 5> wanted = {theta.cross(0.5f * l), theta.cross(2 * l),
                                                 theta.cross(velocity), spin.cross(2 * l),
                                                 spin.cross(velocity)};
  for (size_t k = 0; k < wanted.size(); ++k) {
    INFO("crossed input " << k);
    CHECK((Eigen::Vector3f(values[3 * k], values[3 * k + 1], values[3 * k + 2]) - wanted[k]).norm() < 1e-4f);
  }
}

// Node 1: felt 300 400 500 m/s^2 over (20 rad/s)^2 in units of half a metre; l_hat twice l = 3 4 5 m; a
// sixteenth of a second at 20 rad/s.
TEST_CASE("assemble_inputs_tells_the_base_s_terms_in_length_units_and_radians") {
  Fixture fixture({{InputKind::kFeltStep, 1, kInfinity, 0},
                   {InputKind::kBaseStep, 1, kInfinity, 0},
                   {InputKind::kTurn, 1, kInfinity, 0},
                   {InputKind::kFrequency, 1, kInfinity, 0}});
  REQUIRE(fixture.assemble() == 0);
  const std::vector<float> values = row(fixture, 1, 10), want = {1.5f, 2, 2.5f, 6, 8, 10, -3, -4, -5, 1.25f};
  for (size_t k = 0; k < want.size(); ++k) CHECK(values[k] == Approx(want[k]).epsilon(1e-6));
}

// Sixteen nodes are assembled at a time; what a node is fed does not depend on how many there are.
TEST_CASE("a_node_is_fed_the_same_in_a_region_of_any_size") {
  std::vector<pack::InputRecord> inputs;
  for (const InputKind kind :
       {InputKind::kRestPosition, InputKind::kRestNormal, InputKind::kStiffness, InputKind::kFeltStep,
        InputKind::kVelocity, InputKind::kTurnedForce, InputKind::kFrequency, InputKind::kSpunStep})
    inputs.push_back({kind, 1e-3f, 1, 0});
  Fixture largest(inputs, 40);
  largest.assemble();
  const size_t width = Fixture::width_of(inputs);
  for (const uint32_t nodes : {1u, 15u, 16u, 17u, 39u}) {
    Fixture fixture(inputs, nodes);
    fixture.assemble();
    for (uint32_t n = 0; n < nodes; ++n) REQUIRE(row(fixture, n, width) == row(largest, n, width));
  }
  REQUIRE(row(largest, 39, width) != row(largest, 38, width));
}

TEST_CASE("what_is_clamped_is_counted_in_every_block_of_nodes") {
  Fixture fixture({{InputKind::kGravityChange, 1, 1, 0}}, 40);
  std::fill(fixture.drive.begin(), fixture.drive.end(), 0.0f);
  for (const size_t node : {0u, 15u, 16u, 31u, 32u, 39u})
    fixture.drive[node * tissue::kNodeDriveWidth + 4] = 7;
  REQUIRE(fixture.assemble() == 6);
}
