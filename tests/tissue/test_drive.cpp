// test_drive.cpp  Motions whose parts are known in closed form.
#include "tissue/drive.hpp"

#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <functional>
#include <vector>

using namespace sinew;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr float kTick = 1.0f / 60;
constexpr double kH = kTick;

// Frames and places are double, so what is left is the rounding of r and of the results to float: relative to
// some 100 m/s^2 here.
constexpr double kRounding = 1e-4;
// A place 1e6 m away has 2^-33 m of resolution; its second difference carries four of them over h^2.
constexpr double kFarAway = 4 * 0x1p-33 * 3600 + 1e-6;

using MotionOfTime = std::function<Eigen::Isometry3d(double)>;

enum Part { kLinear, kEuler, kCentrifugal, kArticulation, kAlpha, kOmega, kGravityChange };

struct Parts {
  std::array<float, tissue::kDriveWidth> values;
  Vector3d of(Part part) const {
    return Eigen::Map<const Eigen::Vector3f>(&values[3 * static_cast<size_t>(part)]).cast<double>();
  }
};

tissue::RegionFrame frame_at(const Eigen::Isometry3d& pose) {
  tissue::RegionFrame frame;
  Eigen::Map<Vector3d>(frame.place_m) = pose.translation();
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.rotation) = pose.linear();
  return frame;
}

// Drive at time t of a node at r(time) in the frame.
Parts drive_at(const MotionOfTime& motion, const std::function<Vector3d(double)>& r, double t,
               float tick = kTick) {
  tissue::RegionMotion history{};
  Eigen::Vector3f places[3];
  for (int back = 2; back >= 0; --back) {
    tissue::push_frame(&history, frame_at(motion(t - back * double{tick})));
    places[back] = r(t - back * double{tick}).cast<float>();
  }
  Parts parts;
  tissue::compute_drive(history, tick, places[0].data(), places[1].data(), places[2].data(), 1,
                        parts.values.data());
  return parts;
}

Eigen::Isometry3d posed(const Vector3d& place, const Matrix3d& rotation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = place;
  return pose;
}

const Vector3d kAxis = Vector3d(1, 2, -0.5).normalized();
const Vector3d kNode(0.1, -0.2, 0.15);
Vector3d fixed_node(double) { return kNode; }

// Turning about kAxis by the angle, then by a constant turn, so that no axis is special.
Matrix3d turned(double angle) {
  return (Eigen::AngleAxisd(0.8, Vector3d(0.3, 1, 0.2).normalized()) * Eigen::AngleAxisd(angle, kAxis))
      .toRotationMatrix();
}

void require_near(const Vector3d& have, const Vector3d& want, double tolerance) {
  INFO("have " << have.transpose() << " want " << want.transpose());
  REQUIRE((have - want).norm() <= tolerance);
}

}  // namespace

TEST_CASE("drive_at_rest_in_the_bind_pose_is_zero") {
  const Parts parts = drive_at(
      [](double) {
        return posed({1e5, 3, -2}, Matrix3d::Identity());
      },
      fixed_node, 1);
  for (const float value : parts.values) REQUIRE(value == 0);
}

TEST_CASE("drive_of_a_constant_acceleration_is_that_acceleration_along_the_frame") {
  const Vector3d acceleration(3, -20, 7), velocity(5, 1, 2);
  const auto motion = [&](double t) { return posed(velocity * t + 0.5 * acceleration * t * t, turned(0.4)); };
  const Parts parts = drive_at(motion, fixed_node, 2);
  require_near(parts.of(kLinear), -(turned(0.4).transpose() * acceleration), kRounding);
  for (const Part part : {kEuler, kCentrifugal, kArticulation, kAlpha, kOmega})
    require_near(parts.of(part), Vector3d::Zero(), kRounding);
}

TEST_CASE("drive_of_a_steady_turn_about_the_centre_is_centrifugal_only") {
  constexpr double kSpeed = 12;  // rad/s
  const Parts parts = drive_at(
      [&](double t) {
        return posed({1, 2, 3}, turned(kSpeed * t));
      },
      fixed_node, 0.7);
  const Vector3d omega = kSpeed * kAxis;
  require_near(parts.of(kOmega), omega, kRounding);
  require_near(parts.of(kCentrifugal), -omega.cross(omega.cross(kNode)), kRounding);
  for (const Part part : {kLinear, kEuler, kArticulation, kAlpha})
    require_near(parts.of(part), Vector3d::Zero(), kRounding);
}

TEST_CASE("drive_of_a_turn_that_speeds_up_has_the_euler_part_of_its_angular_acceleration") {
  constexpr double kRate = 30;  // rad/s^2
  const Parts parts = drive_at([&](double t) { return posed(Vector3d::Zero(), turned(0.5 * kRate * t * t)); },
                               fixed_node, 0.4);
  require_near(parts.of(kAlpha), kRate * kAxis, kRounding);
  require_near(parts.of(kEuler), -(kRate * kAxis).cross(kNode), kRounding);
  // Backward differences see the turning speed of half a tick ago.
  require_near(parts.of(kOmega), kRate * (0.4 - kH / 2) * kAxis, kRounding);
}

TEST_CASE("articulation_is_zero_for_any_rigid_motion") {
  const auto wild = [](double t) {
    return posed({std::sin(9 * t), t * t * 20, std::cos(7 * t)}, turned(3 * std::sin(11 * t)));
  };
  for (double t = 0.1; t < 2; t += 0.37) {
    require_near(drive_at(wild, fixed_node, t).of(kArticulation), Vector3d::Zero(), 0);
  }
}

TEST_CASE("articulation_without_turning_is_the_nodes_own_acceleration") {
  const Vector3d acceleration(4, -2, 9);
  const auto r = [&](double t) -> Vector3d { return kNode + 0.5 * acceleration * t * t; };
  const Parts parts = drive_at([](double) { return posed({5, 5, 5}, turned(1)); }, r, 0.1);
  // r is float: 2^-25 m of rounding a place, four places over h^2.
  require_near(parts.of(kArticulation), -acceleration, 4 * 0x1p-25 * 3600);
}

TEST_CASE("parts_add_up_to_less_the_nodes_acceleration_to_first_order_in_the_tick") {
  const auto motion = [](double t) {
    return posed({std::sin(3 * t), t * t, 0}, turned(2 * std::sin(4 * t)));
  };
  const auto r = [](double t) -> Vector3d { return kNode * (1 + 0.3 * std::sin(5 * t)); };
  const auto place = [&](double t) -> Vector3d { return motion(t) * r(t); };
  const auto missing = [&](float tick) {
    const double t = 0.6, e = 1e-4;
    const Vector3d acceleration = (place(t + e) - 2 * place(t) + place(t - e)) / (e * e);
    const Parts parts = drive_at(motion, r, t, tick);
    const Vector3d sum =
        parts.of(kLinear) + parts.of(kEuler) + parts.of(kCentrifugal) + parts.of(kArticulation);
    return (sum + motion(t).linear().transpose() * acceleration).norm();
  };
  REQUIRE(missing(kTick) < 8);  // of some 30 m/s^2
  REQUIRE(missing(kTick / 8) < missing(kTick) / 6);
}

TEST_CASE("drive_far_from_the_origin_equals_the_drive_at_the_origin") {
  const auto motion = [](const Vector3d& origin) {
    return [origin](double t) { return posed(origin + Vector3d(std::sin(9 * t), t, 0), turned(5 * t)); };
  };
  const Parts near = drive_at(motion({0, 0, 0}), fixed_node, 0.5);
  const Parts far = drive_at(motion({1e6, -1e6, 1e6}), fixed_node, 0.5);
  for (int part = kLinear; part <= kGravityChange; ++part) {
    require_near(far.of(static_cast<Part>(part)), near.of(static_cast<Part>(part)), 2 * kFarAway);
  }
}

TEST_CASE("gravity_change_of_a_body_upside_down_is_twice_gravity_upwards_in_its_own_axes") {
  const Matrix3d over = Eigen::AngleAxisd(std::acos(-1.0), Vector3d::UnitZ()).toRotationMatrix();
  require_near(drive_at(
                   [&](double) {
                     return posed({0, 0, 0}, over);
                   },
                   fixed_node, 0)
                   .of(kGravityChange),
               {0, 2 * 9.81, 0}, kRounding);
}

TEST_CASE("push_frame_keeps_the_last_three_newest_first") {
  tissue::RegionMotion motion{};
  for (double place : {1.0, 2.0, 3.0, 4.0})
    tissue::push_frame(&motion, frame_at(posed({place, 0, 0}, Matrix3d::Identity())));
  for (int k = 0; k < 3; ++k) REQUIRE(motion.frame[k].place_m[0] == 4.0 - k);
}

namespace {

// A skin matrix with scale and shear, and a root far away.
struct Posed {
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> skin;
  float center[3] = {0.2f, 1.1f, -0.3f};
  double root_place[3] = {1e6, 5, -1e6};
  float root_turn[4];
  Posed() {
    Matrix3d scaled = turned(0.9) * Vector3d(1.5, 0.7, 2).asDiagonal();
    scaled.col(1) += 0.1 * scaled.col(0);
    skin.leftCols<3>() = scaled.cast<float>();
    skin.col(3) << 0.5f, -0.2f, 0.1f;
    const Eigen::Quaternionf turn(Eigen::AngleAxisf(0.6f, Eigen::Vector3f::UnitY()));
    for (int i = 0; i < 4; ++i) root_turn[i] = 3 * turn.coeffs()[i];
  }
  Matrix3d root() const { return Eigen::AngleAxisd(double{0.6f}, Vector3d::UnitY()).toRotationMatrix(); }
};

constexpr double kFloatPose = 1e-6;  // skin matrices are float, of size 2

}  // namespace

TEST_CASE("region_frame_takes_scale_and_shear_out_and_normalises_the_root") {
  const Posed pose;
  const tissue::RegionFrame frame =
      tissue::region_frame(pose.skin.data(), pose.center, pose.root_place, pose.root_turn);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(frame.rotation);
  REQUIRE((rotation - pose.root() * turned(0.9)).norm() <= 3 * kFloatPose);
  const Eigen::Vector4f center(pose.center[0], pose.center[1], pose.center[2], 1);
  const Vector3d want =
      pose.root() * (pose.skin * center).cast<double>() + Eigen::Map<const Vector3d>(pose.root_place);
  require_near(Eigen::Map<const Vector3d>(frame.place_m), want, kFloatPose);
}

TEST_CASE("region_places_are_the_same_as_in_the_world_for_the_root_cancels") {
  const Posed pose;
  const tissue::RegionFrame frame =
      tissue::region_frame(pose.skin.data(), pose.center, pose.root_place, pose.root_turn);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(frame.rotation);
  const float skinned[6] = {0.3f, 1.0f, 0.2f, -0.4f, 0.9f, 0.1f};
  float r[6];
  tissue::region_places(pose.skin.data(), pose.center, skinned, 2, r);
  for (int node = 0; node < 2; ++node) {
    const Vector3d world =
        pose.root() * Eigen::Map<const Eigen::Vector3f>(skinned + 3 * node).cast<double>() +
        Eigen::Map<const Vector3d>(pose.root_place);
    const Vector3d want = rotation.transpose() * (world - Eigen::Map<const Vector3d>(frame.place_m));
    require_near(Eigen::Map<const Eigen::Vector3f>(r + 3 * node).cast<double>(), want, kFloatPose);
  }
}
