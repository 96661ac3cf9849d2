// test_turn_between.cpp  The smallest turn from one direction to another.
#include <catch2/catch.hpp>
#include <random>

#include "math/turn_between.hpp"

using namespace sinew;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kRounding = 1e-14;
// What is taken for opposite is so within acos(1e-12 - 1).
constexpr double kNearlyOpposite_rad = 1.5e-6;

Vector3d direction(std::mt19937& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  return Vector3d(part(random), part(random), part(random)) + Vector3d::Constant(1e-3);
}

}  // namespace

TEST_CASE("a_direction_of_no_length_turns_nothing") {
  for (const auto& [from, to] : {std::pair<Vector3d, Vector3d>(Vector3d::Zero(), Vector3d::UnitX()),
                                 std::pair<Vector3d, Vector3d>(Vector3d::UnitX(), Vector3d::Zero())}) {
    const Quaterniond turn = core::turn_between(from, to);
    CHECK(turn.vec() == Vector3d::Zero());
    CHECK(turn.w() > 0);
  }
}

TEST_CASE("a_direction_is_turned_to_another_about_an_axis_across_both") {
  std::mt19937 random(1);
  for (int n = 0; n < 1000; ++n) {
    const Vector3d from = direction(random), to = direction(random);
    const Quaterniond turn = core::turn_between(from, 3 * to);
    const double rounding =
        kRounding / (1 + from.normalized().dot(to.normalized()));  // of what is left of one
    REQUIRE(std::abs(turn.norm() - 1) < rounding);
    REQUIRE((turn * from.normalized() - to.normalized()).norm() < rounding);
    REQUIRE(std::abs(turn.vec().dot(from)) < rounding);
    REQUIRE(std::abs(turn.vec().dot(to)) < rounding);
    REQUIRE(turn.w() > 0);
  }
}

TEST_CASE("opposite_directions_are_half_a_turn_apart") {
  for (const double off : {0.0, 1e-9, 1e-7, 5e-7}) {
    for (const Vector3d& from : {Vector3d(1, 0, 0), Vector3d(0, -2, 0), Vector3d(0.3, 0.4, -0.9)}) {
      const Vector3d to = -from + off * Vector3d(0.2, 0.7, 0.1);
      const Quaterniond turn = core::turn_between(from, to);
      INFO("off by " << off);
      CHECK(std::abs(turn.norm() - 1) < kRounding);
      CHECK((turn * from.normalized() - to.normalized()).norm() < kNearlyOpposite_rad);
    }
  }
}

// One and the cosine nearly cancel: what is left of their digits falls with the square of the angle.
TEST_CASE("nearly_opposite_directions_are_turned_as_well_as_a_cosine_tells") {
  for (const double off : {1e-5, 1e-4, 1e-3}) {
    const Vector3d from(0, 0, 1), to = -from + off * Vector3d(0.6, 0.8, 0);
    const Quaterniond turn = core::turn_between(from, to);
    CHECK((turn * from - to.normalized()).norm() < kRounding / (off * off));
  }
}
