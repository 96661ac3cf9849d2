// local_pose.cpp  Poses as joint-local translation, rotation and scale: the form in which they are added up.
#include "baker/truth/motion/local_pose.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
LocalPose local_pose(const Character& character, const std::vector<Matrix4>& joints) {
  LocalPose pose;
  for (size_t j = 0; j < joints.size(); ++j) {
    const int parent = character.joint_parent[j];
    const Matrix4 local =
        parent < 0 ? joints[j] : Matrix4(joints[static_cast<size_t>(parent)].inverse() * joints[j]);
    Eigen::Matrix3d axes = local.topLeftCorner<3, 3>();
    Vector3 scale = axes.colwise().norm();
    if (axes.determinant() < 0)
      scale.x() = -scale.x();  // a mirrored joint: the rotation part must stay a rotation
    for (int k = 0; k < 3; ++k) axes.col(k) /= scale[k] == 0 ? 1 : scale[k];
    pose.translation.emplace_back(local.topRightCorner<3, 1>());
    pose.rotation.emplace_back(Eigen::Quaterniond(axes).normalized());
    pose.scale.push_back(scale);
  }
  return pose;
}

std::vector<Matrix4> joint_matrices(const Character& character, const LocalPose& pose) {
  std::vector<Matrix4> out(pose.rotation.size());
  for (size_t j = 0; j < out.size(); ++j) {
    Matrix4 local = Matrix4::Identity();
    local.topLeftCorner<3, 3>() = pose.rotation[j].toRotationMatrix() * pose.scale[j].asDiagonal();
    local.topRightCorner<3, 1>() = pose.translation[j];
    const int parent = character.joint_parent[j];
    out[j] = parent < 0 ? local : Matrix4(out[static_cast<size_t>(parent)] * local);
  }
  return out;
}

Eigen::Quaterniond rotation_from_vector(const Vector3& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

PoseOffset offset_between(const LocalPose& from, const LocalPose& to) {
  PoseOffset offset;
  for (size_t j = 0; j < from.rotation.size(); ++j) {
    const Eigen::AngleAxisd turn(from.rotation[j].conjugate() * to.rotation[j]);
    offset.translation.emplace_back(to.translation[j] - from.translation[j]);
    offset.scale.emplace_back(to.scale[j] - from.scale[j]);
    offset.rotation.emplace_back(turn.angle() * turn.axis());
  }
  return offset;
}

LocalPose moved_by(LocalPose pose, const PoseOffset& offset, double share) {
  for (size_t j = 0; j < pose.rotation.size(); ++j) {
    pose.translation[j] += share * offset.translation[j];
    pose.scale[j] += share * offset.scale[j];
    pose.rotation[j] = pose.rotation[j] * rotation_from_vector(share * offset.rotation[j]);
  }
  return pose;
}

double ease(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

}  // namespace sinew::baker
