// test_pose.cpp  Poses between poses: exact at the ends, nothing lost, parabolas followed.
#include "character/motion/pose.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/scenes/motions.hpp"

using namespace sinew;
using namespace sinew::world;

namespace {

constexpr double kDt_s = 1.0 / 15;
constexpr float kRounding = 1e-5f;  // a few products of floats of the size of 1

void check_close(const Matrix34& a, const Matrix34& b) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) CHECK(a.m[r][c] == Approx(b.m[r][c]).margin(kRounding));
  }
}

// Sheared, scaled, mirrored, turned.
const Matrix34 kAwkward = {{{0.3f, 1.2f, 0, 2}, {-0.9f, 0.2f, 0.4f, -1}, {0.1f, 0, -2, 0.5f}}};
const Matrix34 kPlain = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
const Matrix34 kFlat = {{{1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 1, 0}}};

Matrix34 turned_about_z(double angle) { return scenes::bent_pose(angle).joints[1]; }

Matrix34 between(const Matrix34& c, const Matrix34& a, const Matrix34& b, double share) {
  return joint_between({}, split_joint(c), split_joint(a), split_joint(b), path_weights(share, kDt_s, kDt_s));
}

}  // namespace

TEST_CASE("joint_path_meets_both_ends_with_nothing_lost") {
  for (const Matrix34& a : {kAwkward, kPlain, kFlat}) {
    for (const Matrix34& b : {kAwkward, kPlain, kFlat}) {
      check_close(between(kAwkward, a, b, 0), a);
      check_close(between(kAwkward, a, b, 1), b);
    }
  }
}

TEST_CASE("steady_turn_is_followed_at_a_steady_rate") {
  for (const double share : {0.25, 0.5, 0.75}) {
    check_close(between(turned_about_z(-0.9), turned_about_z(0), turned_about_z(0.9), share),
                turned_about_z(0.9 * share));
  }
}

TEST_CASE("turn_goes_the_shorter_way") {
  const Matrix34 half = between(turned_about_z(2), turned_about_z(3), turned_about_z(3 + 1), 0.5);
  check_close(half, turned_about_z(3.5));
}

// x = t^2 has one acceleration everywhere: the parabola is exact, the line is not.
TEST_CASE("evenly_accelerated_turn_and_travel_are_followed_exactly") {
  const auto at = [](double t) {
    Matrix34 joint = turned_about_z(0.4 * t * t);
    joint.m[0][3] = static_cast<float>(2 * t * t);
    return joint;
  };
  for (const double share : {-1.0, -0.5, 0.25, 0.5, 0.75}) {
    check_close(between(at(1), at(2), at(3), share), at(2 + share));
  }
}

TEST_CASE("path_weights_fit_unequal_frames_and_fall_back_to_the_line") {
  const PathWeights unequal = path_weights(0.5, 0.02, 0.01);
  // Places t^2 at c = -0.01, a = 0, b = 0.02; half way is t = 0.01.
  const double c = 1e-4, a = 0, b = 4e-4;
  CHECK(a + unequal.next * (b - a) + unequal.past * (a - c) == Approx(1e-4));
  for (const double before_s : {0.0, 0.1, 0.001}) {
    const PathWeights line = path_weights(0.3, 0.02, before_s);
    CHECK(line.next == 0.3);
    CHECK(line.past == 0);
  }
  CHECK(path_weights(-3, 0.02, 0.02).past == 0);
}

// x = t^3, of which the parabola knows nothing.
TEST_CASE("turn_and_travel_whose_acceleration_changes_evenly_are_followed_exactly") {
  const auto at = [](double t) {
    Matrix34 joint = turned_about_z(0.05 * t * t * t);
    joint.m[0][3] = static_cast<float>(0.5 * t * t * t);
    return joint;
  };
  for (const double share : {-1.0, -0.5, 0.25, 0.5, 0.75, 1.0}) {
    check_close(joint_between(split_joint(at(0)), split_joint(at(1)), split_joint(at(2)), split_joint(at(3)),
                              path_weights(share, kDt_s, kDt_s, kDt_s)),
                at(2 + share));
  }
  const PathWeights unequal = path_weights(0.5, 0.02, 0.01, 0.03);
  const auto cube = [](double t) { return t * t * t; };
  CHECK(unequal.next * cube(0.02) + unequal.past * cube(0.01) + unequal.older * (cube(0.04) - cube(0.01)) ==
        Approx(cube(0.01)));
  CHECK(path_weights(0.5, 0.02, 0.01, 0.1).older == 0);  // too unlike
  CHECK(path_weights(0.5, 0.02, 0, 0.02).older == 0);    // c is unknown
}

TEST_CASE("root_path_is_double_and_meets_its_end") {
  RootTransform a, b;
  a.position_m[0] = 1e9;
  b.position_m[0] = 1e9 + 1e-3;
  b.rotation_xyzw[1] = b.rotation_xyzw[3] = std::sqrt(0.5f);
  const RootTransform half = root_between({}, {}, a, b, {.next = 0.5});
  CHECK(half.position_m[0] - 1e9 == Approx(5e-4).epsilon(1e-3));
  CHECK(half.rotation_xyzw[1] == Approx(std::sin(3.14159265 / 8)));
}

TEST_CASE("pose_quaternion_is_normalised_on_entry") {
  RootTransform given{.rotation_xyzw = {0, 3, 0, 4}}, root;
  REQUIRE(check_root(given, &root).ok());
  CHECK(root.rotation_xyzw[1] == Approx(0.6));
  CHECK(root.rotation_xyzw[3] == Approx(0.8));
}
