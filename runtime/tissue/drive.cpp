// drive.cpp  Splits motion into parts, in double where the world's size comes in.
#include "tissue/drive.hpp"

#include <Eigen/Geometry>

namespace sinew::tissue {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kGravity = 9.81;  // m/s^2, along -Y

Matrix3d rotation_of(const RegionFrame& frame) { return Eigen::Map<const RowMajor>(frame.rotation); }
Vector3d place_of(const RegionFrame& frame) { return Eigen::Map<const Vector3d>(frame.place_m); }
Vector3d vector_at(const float* v, uint32_t i) {
  return Eigen::Map<const Eigen::Vector3f>(v + size_t{i} * 3).cast<double>();
}

// Rotation vector of a rotation matrix; exact through zero.
Vector3d log_rotation(const Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  const double scale = sine > 1e-12 ? 2 * std::atan2(sine, q.w()) / sine : 2;
  return q.vec() * scale;
}

// Columns orthonormal, the first kept in direction: what is left of a skin matrix without scale and shear.
Matrix3d orthonormal(const Matrix3d& m) {
  const Vector3d x = m.col(0).normalized();
  const Vector3d y = (m.col(1) - x * x.dot(m.col(1))).normalized();
  Matrix3d rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

Matrix3d linear_part(const float skin[12]) {
  Matrix3d m;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m(r, c) = skin[4 * r + c];
  }
  return m;
}

Vector3d moved_center(const float skin[12], const float center_m[3]) {
  return linear_part(skin) * vector_at(center_m, 0) + Vector3d(skin[3], skin[7], skin[11]);
}

Matrix3d root_rotation(const float xyzw[4]) {
  return Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized().toRotationMatrix();
}

// What all nodes of a region share.
struct FrameDrive {
  Vector3d acceleration, velocity_angular, acceleration_angular, gravity_change;
  Matrix3d now_from_before, now_from_before2;  // R_t^T R_{t-1}, R_t^T R_{t-2}
  double h;
};

FrameDrive frame_drive(const RegionMotion& motion, double h) {
  const Matrix3d now = rotation_of(motion.frame[0]).transpose();
  const Matrix3d before = rotation_of(motion.frame[1]), before2 = rotation_of(motion.frame[2]);
  // Differences first: places may be millions of metres from the origin.
  const Vector3d step = place_of(motion.frame[0]) - place_of(motion.frame[1]);
  const Vector3d step_before = place_of(motion.frame[1]) - place_of(motion.frame[2]);
  const Vector3d omega = log_rotation(before.transpose() * now.transpose()) / h;
  const Vector3d omega_before = log_rotation(before2.transpose() * before) / h;
  const Vector3d gravity(0, -kGravity, 0);
  return {.acceleration = now * (step - step_before) / (h * h),
          .velocity_angular = omega,
          .acceleration_angular = (omega - omega_before) / h,
          .gravity_change = now * gravity - gravity,
          .now_from_before = now * before,
          .now_from_before2 = now * before2,
          .h = h};
}

void node_drive(const FrameDrive& frame, const Vector3d& r, const Vector3d& r_before,
                const Vector3d& r_before2, float* out) {
  const Vector3d& omega = frame.velocity_angular;
  const Vector3d articulation =
      (frame.now_from_before2 * (r_before2 - r) - 2 * (frame.now_from_before * (r_before - r))) /
      (frame.h * frame.h);
  const Vector3d parts[kDriveWidth / 3] = {-frame.acceleration,          -frame.acceleration_angular.cross(r),
                                           -omega.cross(omega.cross(r)), -articulation,
                                           frame.acceleration_angular,   omega,
                                           frame.gravity_change};
  for (const Vector3d& part : parts) {
    for (int axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(part[axis]);
  }
}

}  // namespace

void push_frame(RegionMotion* motion, const RegionFrame& now) noexcept {
  motion->frame[2] = motion->frame[1];
  motion->frame[1] = motion->frame[0];
  motion->frame[0] = now;
}

void compute_drive(const RegionMotion& motion, float tick_s, const float* r_now, const float* r_before,
                   const float* r_before2, uint32_t count, float* out) noexcept {
  const FrameDrive frame = frame_drive(motion, tick_s);
  for (uint32_t i = 0; i < count; ++i) {
    node_drive(frame, vector_at(r_now, i), vector_at(r_before, i), vector_at(r_before2, i),
               out + size_t{i} * kDriveWidth);
  }
}

RegionFrame region_frame(const float skin[12], const float center_m[3], const double root_position_m[3],
                         const float root_rotation_xyzw[4]) noexcept {
  const Matrix3d root = root_rotation(root_rotation_xyzw);
  const Vector3d place = root * moved_center(skin, center_m) + Eigen::Map<const Vector3d>(root_position_m);
  RegionFrame frame;
  Eigen::Map<Vector3d>(frame.place_m) = place;
  Eigen::Map<RowMajor>(frame.rotation) = root * orthonormal(linear_part(skin));
  return frame;
}

void region_places(const float skin[12], const float center_m[3], const float* skinned_m, uint32_t count,
                   float* r) noexcept {
  const Matrix3d inverse = orthonormal(linear_part(skin)).transpose();
  const Vector3d center = moved_center(skin, center_m);
  for (uint32_t i = 0; i < count; ++i) {
    Eigen::Map<Eigen::Vector3f>(r + size_t{i} * 3) =
        (inverse * (vector_at(skinned_m, i) - center)).cast<float>();
  }
}

}  // namespace sinew::tissue
