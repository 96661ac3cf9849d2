// node_drive.cpp  Differences of the last three ticks, turned into each node's own axes.
#include "tissue/node_drive.hpp"

#include <Eigen/Core>

namespace sinew::tissue {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

constexpr float kGravity = 9.80665f;  // m/s^2, along -Y

Vector3f place_of(const NodePose& pose) { return Eigen::Map<const Vector3f>(pose.place_m); }
Matrix3f rotation_of(const NodePose& pose) { return Eigen::Map<const Rows33>(pose.rotation); }

// Second difference of the root's place: in double first, since places may be millions of metres from the
// origin.
Vector3f root_step_change(const NodeMotion& motion) {
  Vector3f change;
  for (int k = 0; k < 3; ++k) {
    const double step = motion.root_position_m[0][k] - motion.root_position_m[1][k];
    const double before = motion.root_position_m[1][k] - motion.root_position_m[2][k];
    change[k] = static_cast<float>(step - before);
  }
  return change;
}

Vector3f turn_a_tick(const Matrix3f& before, const Matrix3f& now) {
  const Matrix3f a = before.transpose() * now;
  return 0.5f * Vector3f(a(2, 1) - a(1, 2), a(0, 2) - a(2, 0), a(1, 0) - a(0, 1));
}

}  // namespace

void compute_node_drive(const NodeMotion& motion, float tick_s, uint32_t count, float* out) noexcept {
  const Vector3f gravity(0, -kGravity, 0), root = root_step_change(motion);
  for (uint32_t i = 0; i < count; ++i) {
    const NodePose &now = motion.pose[0][i], &before = motion.pose[1][i], &before2 = motion.pose[2][i];
    const Matrix3f r = rotation_of(now), r_before = rotation_of(before);
    const Vector3f steps = (place_of(now) - place_of(before)) - (place_of(before) - place_of(before2));
    const Vector3f omega = turn_a_tick(r_before, r) / tick_s;
    const Vector3f omega_before = turn_a_tick(rotation_of(before2), r_before) / tick_s;
    const Vector3f parts[kNodeDriveWidth / 3] = {
        r.transpose() * (gravity - (steps + root) / (tick_s * tick_s)) - gravity,
        r.transpose() * gravity - gravity, omega, (omega - omega_before) / tick_s};
    for (const Vector3f& part : parts) {
      for (int axis = 0; axis < 3; ++axis) *out++ = part[axis];
    }
  }
}

}  // namespace sinew::tissue
