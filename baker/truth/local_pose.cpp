// local_pose.cpp  Poses as joint-local translation, rotation and scale: the form in which they blend.
#include "baker/truth/local_pose.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

constexpr double kSampleRateHz = 60;
constexpr double kSeam_s = 0.25;       // over which an open clip is eased into its first pose
constexpr double kOpenAngleRad = 0.1;  // first and last pose further apart than this: the clip is not a loop

double largest_turn(const LocalPose& a, const LocalPose& b) {
  double turn = 0;
  for (size_t j = 0; j < a.rotation.size(); ++j)
    turn = std::max(turn, a.rotation[j].angularDistance(b.rotation[j]));
  return turn;
}

LocalPose weighted_sum(const std::array<const LocalPose*, 4>& poses, const std::array<double, 4>& weight) {
  const size_t joints = poses[0]->rotation.size();
  LocalPose out;
  out.translation.assign(joints, Vector3::Zero());
  out.scale.assign(joints, Vector3::Zero());
  out.rotation.resize(joints);
  for (size_t j = 0; j < joints; ++j) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (size_t k = 0; k < 4; ++k) {
      const Eigen::Vector4d& q = poses[k]->rotation[j].coeffs();
      sum += q * (q.dot(poses[0]->rotation[j].coeffs()) < 0 ? -weight[k] : weight[k]);
      out.translation[j] += weight[k] * poses[k]->translation[j];
      out.scale[j] += weight[k] * poses[k]->scale[j];
    }
    out.rotation[j].coeffs() = sum.normalized();
  }
  return out;
}

}  // namespace

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

LocalPose blend(const LocalPose& a, const LocalPose& b, double weight) {
  LocalPose out = a;
  for (size_t j = 0; j < a.rotation.size(); ++j) {
    out.translation[j] += weight * (b.translation[j] - a.translation[j]);
    out.scale[j] += weight * (b.scale[j] - a.scale[j]);
    const Eigen::AngleAxisd turn(a.rotation[j].conjugate() *
                                 b.rotation[j]);  // angle in 0..pi: the shortest arc
    out.rotation[j] = a.rotation[j] * rotation_from_vector(weight * turn.angle() * turn.axis());
  }
  return out;
}

double ease(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

SmoothClip::SmoothClip(const Character& character, const Clip& clip)
    : duration_s_(std::max(clip.duration_s, 1 / kSampleRateHz)) {
  const auto count = std::max<size_t>(4, static_cast<size_t>(std::lround(duration_s_ * kSampleRateHz)));
  for (size_t i = 0; i < count; ++i) {
    const double t = duration_s_ * static_cast<double>(i) / static_cast<double>(count);
    samples_.push_back(local_pose(character, sinew::baker::joint_matrices(character, &clip, t)));
  }
  const LocalPose end =
      local_pose(character, sinew::baker::joint_matrices(character, &clip, clip.duration_s));
  if (largest_turn(samples_.front(), end) < kOpenAngleRad) return;
  for (size_t i = 1; i < count; ++i) {
    const double left_s = duration_s_ * (1 - static_cast<double>(i) / static_cast<double>(count));
    if (left_s < kSeam_s) samples_[i] = blend(samples_[i], samples_[0], ease(1 - left_s / kSeam_s));
  }
}

LocalPose SmoothClip::at(double t_s) const {
  const auto count = static_cast<double>(samples_.size());
  const double turns = t_s / duration_s_;
  const double place = (turns - std::floor(turns)) * count;
  const auto first = static_cast<size_t>(place);
  const double u = place - std::floor(place), v = 1 - u;
  const std::array<double, 4> weight = {v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6,
                                        (4 - 6 * v * v + 3 * v * v * v) / 6, u * u * u / 6};
  std::array<const LocalPose*, 4> near{};
  for (size_t k = 0; k < 4; ++k) near[k] = &samples_[(first + samples_.size() + k - 1) % samples_.size()];
  return weighted_sum(near, weight);
}

}  // namespace sinew::baker
