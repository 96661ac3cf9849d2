// scenes.cpp  see scenes.hpp.
#include "samples/contacts/scenes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "baker/common/bad_input.hpp"

namespace sinew::sample {
namespace {

using Eigen::Vector3d;

// From 0 to 1 while t goes from a to b, at rest at both ends.
double rise(double t, double a, double b) {
  const double s = std::clamp((t - a) / (b - a), 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

std::function<Vector3d(double)> still(const Vector3d& at) {
  return [at](double) { return at; };
}

// The shorter way from one direction to another, a share of it.
Eigen::AngleAxisd part_of_turn(const Vector3d& from, const Vector3d& to, double share) {
  Eigen::AngleAxisd turn(Eigen::Quaterniond::FromTwoVectors(from, to));
  turn.angle() *= share;
  return turn;
}

size_t joint_called(const demo::CharacterFile& character, const std::string& name) {
  const auto& joints = character.view.joints;
  for (size_t j = 0; j < joints.size(); ++j)
    if (pack::string_at(character.view, joints[j].name) == name) return j;
  throw baker::BadInput(character.path + ": has no joint called " + name);
}

Vector3d place_of(const Matrix34& joint) { return {joint.m[0][3], joint.m[1][3], joint.m[2][3]}; }

void turn_about(const Vector3d& place, const Eigen::AngleAxisd& turn, Matrix34& joint) {
  using Rows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
  Eigen::Affine3d moved = Eigen::Affine3d::Identity();
  moved.matrix().topRows<3>() = Eigen::Map<const Rows>(&joint.m[0][0]).cast<double>();
  moved = Eigen::Translation3d(place) * turn * Eigen::Translation3d(-place) * moved;
  Eigen::Map<Rows>(&joint.m[0][0]) = moved.matrix().topRows<3>().cast<float>();
}

// side: 1 left, -1 right.
void bring_arm(const demo::CharacterFile& character, double side, double share, std::span<Matrix34> joints) {
  const Vector3d upper_way(0.42 * side, -0.415, 0.805), lower_way(-0.41 * side, -0.468, 0.78);
  const std::string end = side > 0 ? "_l" : "_r";
  Matrix34 *upper = &joints[joint_called(character, "arm_upper" + end)],
           *lower = &joints[joint_called(character, "arm_lower" + end)],
           *hand = &joints[joint_called(character, "hand" + end)];
  const auto lift = part_of_turn(place_of(*lower) - place_of(*upper), upper_way, share);
  const Vector3d shoulder = place_of(*upper);
  for (Matrix34* joint : {upper, lower, hand}) turn_about(shoulder, lift, *joint);
  const auto fold = part_of_turn(place_of(*hand) - place_of(*lower), lower_way, share);
  const Vector3d elbow = place_of(*lower);
  for (Matrix34* joint : {lower, hand}) turn_about(elbow, fold, *joint);
}

const render::Rgb kWood = {0.55f, 0.38f, 0.22f}, kWall = {0.45f, 0.5f, 0.58f};

}  // namespace

ContactScene onto_a_crate() {
  constexpr double kLeap_s = 0.5, kLanded_s = 1.1, kTurn_rad = 1.45;
  constexpr double kTop_m = 0.36, kBelly_m = 0.31, kFront_m = 0.205, kPress_m = 0.04;
  const Vector3d half(0.16, kTop_m / 2, 0.15), crate(0, kTop_m / 2, 0.6);
  // Lying, the belly's front is kFront_m - kPress_m over the crate, its middle over the crate's.
  const auto root = [=](double t) {
    const double turn = kTurn_rad * rise(t, kLeap_s, kLanded_s);
    const double up = rise(t, kLeap_s, kLanded_s),
                 s = std::clamp((t - kLeap_s) / (kLanded_s - kLeap_s), 0.0, 1.0);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(turn, Vector3d::UnitX()));
    const Vector3d lying = crate + Vector3d(0, kTop_m / 2 + kFront_m - kPress_m, 0) -
                           Eigen::AngleAxisd(kTurn_rad, Vector3d::UnitX()) * Vector3d(0, kBelly_m, 0);
    const Vector3d place = up * lying + Vector3d(0, 0.35 * 4 * s * (1 - s), 0);
    RootTransform out;
    std::copy_n(place.data(), 3, out.position_m);
    for (int k = 0; k < 4; ++k) out.rotation_xyzw[k] = static_cast<float>(q.coeffs()[k]);
    return out;
  };
  return {.name = "crate",
          .title = "Onto a crate",
          .boxes = {{half, still(crate), kWood}},
          .root = root,
          .seconds = 5,
          .moments_s = {0.85, 1.0, 1.1, 1.2, 4.9},
          .rest_from_s = 4,
          .view = {.yaw_deg = 70, .pitch_deg = 4},
          .shown = Eigen::AlignedBox3f(Eigen::Vector3f(-0.3f, 0.02f, 0.2f), Eigen::Vector3f(0.3f, 0.75f, 1)),
          .sees_into = true};
}

ContactScene between_walls() {
  constexpr double kClose_s = 0.3, kClosed_s = 1.3, kOpen_s = 4, kOpened_s = 4.4;
  const Vector3d post(0.12, 0.3, 0.1), half(0.45, 0.3, 0.1);
  // Closed, the front one is 5 cm into the belly, the other 10 cm into the tail.
  const auto wall = [=](double open_z, double closed_z) {
    return [=](double t) {
      const double closed = rise(t, kClose_s, kClosed_s) - rise(t, kOpen_s, kOpened_s);
      return Vector3d(0, 0.3, open_z + closed * (closed_z - open_z));
    };
  };
  return {.name = "walls",
          .title = "Between two walls",
          .boxes = {{post, wall(0.5, 0.155 + 0.1), kWall}, {half, wall(-0.95, -0.55 - 0.1), kWall}},
          .root = [](double) { return RootTransform{}; },
          .seconds = 5.5,
          .moments_s = {0.2, 0.9, 3.9, 4.25, 4.45},
          .rest_from_s = 3,
          .view = {.yaw_deg = 80, .pitch_deg = 14}};
}

ContactScene arms_on_the_belly() {
  constexpr double kReach_s = 0.4, kPressed_s = 1.1, kLeave_s = 4, kLeft_s = 4.35;
  const auto pose = [=](const demo::CharacterFile& character, double t, std::span<Matrix34> joints) {
    const double share = rise(t, kReach_s, kPressed_s) - rise(t, kLeave_s, kLeft_s);
    for (const double side : {1.0, -1.0}) bring_arm(character, side, share, joints);
  };
  return {
      .name = "belly",
      .title = "Arms on the belly",
      .boxes = {},
      .root = [](double) { return RootTransform{}; },
      .pose = pose,
      .limbs = {"hand_"},
      .seconds = 5.5,
      .moments_s = {0.3, 0.85, 3.9, 3.9},
      .rest_from_s = 3,
      .view = {.yaw_deg = 40, .pitch_deg = 7},
      .shown = Eigen::AlignedBox3f(Eigen::Vector3f(-0.3f, 0.1f, -0.1f), Eigen::Vector3f(0.3f, 0.65f, 0.3f)),
      .left_out = {"arm_lower_", "hand_"}};
}

}  // namespace sinew::sample
