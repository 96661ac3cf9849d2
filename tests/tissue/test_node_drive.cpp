// test_node_drive.cpp  Motions whose drive is known in closed form.
#include "tissue/frames/node_drive.hpp"

#include <catch2/catch.hpp>
#include <functional>

#include "tests/tissue/node_poses.hpp"

using namespace sinew;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kTick_s = 1.0 / 60;
const Vector3d kGravity(0, -9.80665, 0);
// A place of a metre is rounded by 6e-8; its second difference carries four of them over h^2 = 1/3600.
constexpr double kRounding = 4 * 6e-8 * 3600;

struct Drive {
  Vector3d felt, gravity_change, velocity, acceleration, bend;
};

// rotation and place (from the root) at t; root of the root.
Drive drive_at(const std::function<Matrix3d(double)>& rotation, const std::function<Vector3d(double)>& place,
               const std::function<Vector3d(double)>& root, double t) {
  tissue::NodePose poses[3];
  tissue::NodeMotion motion;
  for (int tick = 0; tick < 3; ++tick) {
    const double then = t - tick * kTick_s;
    poses[tick] = test::node_pose(rotation(then), place(then));
    motion.pose[tick] = &poses[tick];
    Eigen::Map<Vector3d>(motion.root_position_m[tick]) = root(then);
  }
  float out[tissue::kNodeDriveWidth];
  tissue::compute_node_drive(motion, static_cast<float>(kTick_s), 1, out);
  const auto part = [&](int k) { return Vector3d(Eigen::Map<Eigen::Vector3f>(out + 3 * k).cast<double>()); };
  return {part(0), part(1), part(2), part(3), part(4)};
}

Vector3d nowhere(double) { return {0, 0, 0}; }
Vector3d somewhere(double) { return {0.1, 0.7, -0.2}; }
Matrix3d upright(double) { return Matrix3d::Identity(); }

}  // namespace

TEST_CASE("drive_at_rest_in_the_bind_pose_is_zero") {
  const Drive drive = drive_at(
      upright, somewhere, [](double) { return Vector3d(1e6, 3, -2); }, 1);
  for (const Vector3d& part :
       {drive.felt, drive.gravity_change, drive.velocity, drive.acceleration, drive.bend})
    CHECK(part.norm() == 0);
}

TEST_CASE("a_turned_node_at_rest_feels_gravity_s_change_alone") {
  const Drive drive = drive_at([](double) { return test::turned(0.4); }, somewhere, nowhere, 1);
  const Vector3d change = test::turned(0.4).transpose() * kGravity - kGravity;
  CHECK((drive.gravity_change - change).norm() < 1e-5);
  CHECK((drive.felt - change).norm() < 1e-5);
  CHECK(drive.velocity.norm() < 1e-4);  // of a rotation's rounding, times 60
}

TEST_CASE("acceleration_is_felt_the_other_way_along_the_node_s_axes") {
  const Vector3d a(3, -20, 7), v(5, 1, 2);
  const auto root = [&](double t) { return Vector3d(v * t + a * t * t / 2); };
  const Drive drive = drive_at([](double) { return test::turned(0.4); }, somewhere, root, 2);
  const Vector3d want = test::turned(0.4).transpose() * (kGravity - a) - kGravity;
  CHECK((drive.felt - want).norm() < kRounding);
}

// Of the bound shape's gravity, which its rest shape bears, flesh that is bent beyond its frame feels what it
// had in itself.
TEST_CASE("bent_flesh_at_rest_feels_what_its_own_turn_changes_of_gravity") {
  const Vector3d bend(0.3, -0.2, 0.4);
  tissue::NodePose pose = test::node_pose(test::turned(0.4));
  for (int k = 0; k < 3; ++k) pose.bend[k] = static_cast<float>(bend[k]);
  const tissue::NodeMotion motion{{}, {&pose, &pose, &pose}};
  float out[tissue::kNodeDriveWidth];
  tissue::compute_node_drive(motion, static_cast<float>(kTick_s), 1, out);
  const Matrix3d frame = test::turned(0.4);
  const Matrix3d flesh = frame * Eigen::AngleAxisd(bend.norm(), bend.normalized()).toRotationMatrix();
  const Vector3d want = frame.transpose() * (kGravity - flesh * kGravity);
  for (int k = 0; k < 3; ++k) {
    CHECK(static_cast<double>(out[k]) == Approx(want[k]).margin(1e-5));
    CHECK(static_cast<double>(out[3 + k]) == Approx(want[k]).margin(1e-5));
  }
}

TEST_CASE("the_bend_is_told_as_the_newest_frame_has_it") {
  tissue::NodePose poses[2] = {test::node_pose(upright(0)), test::node_pose(upright(0))};
  for (int k = 0; k < 3; ++k) poses[0].bend[k] = 0.1f * static_cast<float>(k + 1);
  const tissue::NodeMotion motion{{}, {&poses[0], &poses[1], &poses[1]}};
  float out[tissue::kNodeDriveWidth];
  tissue::compute_node_drive(motion, static_cast<float>(kTick_s), 1, out);
  for (int k = 0; k < 3; ++k) CHECK(out[12 + k] == poses[0].bend[k]);
}

TEST_CASE("free_fall_is_felt_as_weightlessness") {
  const auto root = [](double t) { return Vector3d(kGravity * t * t / 2); };
  CHECK((drive_at(upright, somewhere, root, 2).felt + kGravity).norm() < kRounding);
}

// A place 1e6 m away has 2^-33 m of resolution; its second difference carries four of them over h^2.
TEST_CASE("drive_is_the_same_a_thousand_kilometres_away") {
  const Vector3d a(3, -20, 7), far(1e6, -4e5, 8e5);
  const auto near = [&](double t) { return Vector3d(a * t * t / 2); };
  const auto away = [&](double t) { return Vector3d(near(t) + far); };
  const Vector3d difference =
      drive_at(upright, somewhere, near, 1).felt - drive_at(upright, somewhere, away, 1).felt;
  CHECK(difference.norm() < 2 * 4 * 0x1p-33 * 3600 + 1e-5);
}

TEST_CASE("a_steady_turn_has_angular_velocity_and_no_angular_acceleration") {
  constexpr double kRate = 5;  // rad/s; the drive tells the sine of a tick's turn
  const Drive drive = drive_at([](double t) { return test::turned(kRate * t); }, nowhere, nowhere, 1);
  const Vector3d axis = Vector3d(1, 2, -0.5).normalized();
  CHECK((drive.velocity - std::sin(kRate * kTick_s) / kTick_s * axis).norm() < 1e-4);
  CHECK(drive.acceleration.norm() < 1e-7 * 3600 * 4);
}

TEST_CASE("a_turn_that_quickens_has_angular_acceleration") {
  constexpr double kAlpha = 40;
  const Drive drive =
      drive_at([](double t) { return test::turned(kAlpha * t * t / 2); }, nowhere, nowhere, 2 * kTick_s);
  const Vector3d axis = Vector3d(1, 2, -0.5).normalized();
  CHECK((drive.acceleration - kAlpha * axis).norm() < 0.01 * kAlpha);
}
