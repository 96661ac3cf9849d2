// test_constraints.cpp  Values by hand, derivatives against differences.
#include "rods/solver/constraints.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "rods/turn.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using rods::Constraint;
using rods::JointEnd;

namespace {

constexpr double kDifference = 1e-6;  // central: the error is its square over six, near rounding's
constexpr double kDerivativeError = 1e-8;

JointEnd random_end(std::mt19937& random) {
  JointEnd end{{}, {}, 0.7};
  rods::Turn q;
  for (double& v : q) v = static_cast<double>(test::uniform(random, -1, 1));
  q = rods::normalised(q);
  for (size_t k = 0; k < 4; ++k) end.orientation[k] = q[k];
  for (double& v : end.position_m) v = static_cast<double>(test::uniform(random, -1, 1));
  return end;
}

JointEnd turned_by(JointEnd end, size_t axis, double angle) {
  rods::Turn q, by = {0, 0, 0, 1};
  for (size_t k = 0; k < 4; ++k) q[k] = end.orientation[k];
  by[axis] = angle / 2;
  q = rods::normalised(rods::product(q, by));
  for (size_t k = 0; k < 4; ++k) end.orientation[k] = q[k];
  return end;
}

JointEnd moved_by(JointEnd end, size_t axis, double distance) {
  end.position_m[axis] += distance;
  return end;
}

template <class Evaluate>
void check_derivatives(const Evaluate& evaluate) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const JointEnd a = random_end(random), b = random_end(random);
    const Constraint c = evaluate(a, b);
    for (size_t k = 0; k < 3; ++k) {
      const auto check = [&](const Constraint& more, const Constraint& less, const double(&by)[3][3]) {
        for (size_t r = 0; r < 3; ++r) {
          CHECK(std::fabs((more.value[r] - less.value[r]) / (2 * kDifference) - by[r][k]) < kDerivativeError);
        }
      };
      const double e = kDifference;
      check(evaluate(moved_by(a, k, e), b), evaluate(moved_by(a, k, -e), b), c.by_parent_position);
      check(evaluate(a, moved_by(b, k, e)), evaluate(a, moved_by(b, k, -e)), c.by_child_position);
      check(evaluate(turned_by(a, k, e), b), evaluate(turned_by(a, k, -e), b), c.by_parent_rotation);
      check(evaluate(a, turned_by(b, k, e)), evaluate(a, turned_by(b, k, -e)), c.by_child_rotation);
    }
  }
}

}  // namespace

TEST_CASE("constraints_refuse_what_has_none") {
  std::mt19937 random(3);
  const JointEnd good = random_end(random);
  const double rest[3] = {0, 0, 0};
  std::vector<JointEnd> bad(5, good);
  bad[0].length_m = 0;
  bad[1].position_m[2] = std::numeric_limits<double>::quiet_NaN();
  for (double& q : bad[2].orientation) q = 0;
  for (double& q : bad[3].orientation) q *= 1.01;
  bad[4].orientation[1] = std::numeric_limits<double>::infinity();
  for (const JointEnd& end : bad) {
    Constraint out{};
    out.value[0] = 42;
    double shape[3] = {42, 0, 0};
    for (const bool as_parent : {true, false}) {
      const JointEnd &a = as_parent ? end : good, &b = as_parent ? good : end;
      CHECK_FALSE(rods::stretch_shear(a, b, &out));
      CHECK_FALSE(rods::bend_twist(a, b, rest, &out));
      CHECK_FALSE(rods::darboux(a, b, shape));
    }
    CHECK(out.value[0] == 42);
    CHECK(shape[0] == 42);
  }
  const double bad_rest[3] = {0, std::numeric_limits<double>::infinity(), 0};
  Constraint out;
  CHECK_FALSE(rods::bend_twist(good, good, bad_rest, &out));
}

TEST_CASE("segments_that_meet_do_not_stretch_and_segments_that_do_not_stretch_by_their_gap") {
  const JointEnd a{{0, 0, 1}, {0, 0, 0, 1}, 2}, b{{0.25, 0, 3}, {0, 0, 0, 1}, 2};
  Constraint c;
  REQUIRE(rods::stretch_shear(a, b, &c));
  CHECK(c.value[0] == -0.25);
  CHECK(c.value[1] == 0);
  CHECK(c.value[2] == 0);
}

TEST_CASE("a_quarter_turn_bends_by_the_root_of_two_less_rest") {
  const double half = std::sqrt(0.5);
  const JointEnd a{{0, 0, 0}, {0, 0, 0, 1}, 1}, b{{0, 0, 0}, {half, 0, 0, half}, 1};
  const double rest[3] = {0.1, 0.2, 0.3};
  Constraint c;
  REQUIRE(rods::bend_twist(a, b, rest, &c));
  CHECK(c.value[0] == Approx(std::sqrt(2.0) - 0.1));
  CHECK(c.value[1] == Approx(-0.2));
  CHECK(c.value[2] == Approx(-0.3));
}

TEST_CASE("an_orientation_and_its_negative_bend_alike") {
  std::mt19937 random(11);
  const JointEnd a = random_end(random), b = random_end(random);
  JointEnd opposite = b;
  for (double& q : opposite.orientation) q = -q;
  double one[3], other[3];
  REQUIRE(rods::darboux(a, b, one));
  REQUIRE(rods::darboux(a, opposite, other));
  for (int k = 0; k < 3; ++k) CHECK(one[k] == Approx(other[k]).margin(1e-15));
}

TEST_CASE("derivatives_of_stretch_and_shear_are_those_of_the_value") {
  check_derivatives([](const JointEnd& a, const JointEnd& b) {
    Constraint c;
    REQUIRE(rods::stretch_shear(a, b, &c));
    return c;
  });
}

TEST_CASE("derivatives_of_bend_and_twist_are_those_of_the_value") {
  check_derivatives([](const JointEnd& a, const JointEnd& b) {
    const double rest[3] = {0.1, -0.2, 0.05};
    Constraint c;
    REQUIRE(rods::bend_twist(a, b, rest, &c));
    return c;
  });
}
