// pose.cpp  Poses: checked on entry, interpolated at ticks, made into skin matrices.
#include "character/motion/pose.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/status.hpp"
#include "math/rotation.hpp"

namespace sinew::world {
namespace {

using core::make_status;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector3f;
using RowMatrix3 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
using RowMatrix34 = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

// Beyond these, products of two matrices or the spacing of doubles are no longer of use to anyone.
constexpr float kLargestJointEntry = 1e6f;
constexpr double kFarthestRoot_m = 1e12;

Eigen::Map<const RowMatrix34> map(const Matrix34& m) noexcept {
  return Eigen::Map<const RowMatrix34>(&m.m[0][0]);
}

Status check_joint(const Matrix34& joint, size_t index) noexcept {
  float largest = 0;
  for (const auto& row : joint.m) {
    for (float value : row) {
      if (!std::isfinite(value)) {
        return make_status(StatusCode::kNotFinite,
                           "pose: joint %zu holds NaN or infinity; the last valid pose remains in use",
                           index);
      }
      largest = std::max(largest, std::abs(value));
    }
  }
  if (largest <= kLargestJointEntry) return {};
  return make_status(StatusCode::kInvalidArgument,
                     "pose: joint %zu holds %g, beyond +-%g; are the units metres?", index,
                     static_cast<double>(largest), static_cast<double>(kLargestJointEntry));
}

// Gram-Schmidt on the columns; identity where the matrix has no three directions.
RowMatrix3 rotation_of(const RowMatrix3& m) noexcept {
  constexpr float kDegenerate = 1e-12f;
  Vector3f x = m.col(0);
  if (x.norm() < kDegenerate) return RowMatrix3::Identity();
  x.normalize();
  Vector3f y = m.col(1) - x * x.dot(m.col(1));
  if (y.norm() < kDegenerate) return RowMatrix3::Identity();
  y.normalize();
  RowMatrix3 rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

}  // namespace

Status check_root(const RootTransform& given, RootTransform* root) noexcept {
  constexpr float kShortest = 1e-6f;
  constexpr double kLeastScale = 1e-3;
  for (double place : given.position_m) {
    if (!std::isfinite(place))
      return make_status(StatusCode::kNotFinite, "root: position holds NaN or infinity");
    if (std::abs(place) > kFarthestRoot_m) {
      return make_status(StatusCode::kInvalidArgument, "root: position %g m lies beyond +-%g m", place,
                         kFarthestRoot_m);
    }
  }
  if (!std::isfinite(given.scale))
    return make_status(StatusCode::kNotFinite, "root: scale is NaN or infinity");
  if (!(given.scale >= kLeastScale && given.scale <= 1 / kLeastScale)) {
    return make_status(StatusCode::kInvalidArgument, "root: scale %g is not in %g..%g", given.scale,
                       kLeastScale, 1 / kLeastScale);
  }
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4f>(given.rotation_xyzw).cast<double>();
  const double length = q.norm();
  if (!std::isfinite(length))
    return make_status(StatusCode::kNotFinite, "root: rotation holds NaN or infinity");
  if (length < kShortest) {
    return make_status(StatusCode::kInvalidArgument,
                       "root: rotation has zero length; the identity is 0 0 0 1");
  }
  std::copy_n(given.position_m, 3, root->position_m);
  root->scale = given.scale;
  Eigen::Map<Eigen::Vector4f>(root->rotation_xyzw) = (q / length).cast<float>();
  return {};
}

bool same_root(const RootTransform& a, const RootTransform& b) noexcept {
  return a.scale == b.scale && std::equal(a.position_m, a.position_m + 3, b.position_m) &&
         std::equal(a.rotation_xyzw, a.rotation_xyzw + 4, b.rotation_xyzw);
}

RootTransform in_own_metres(RootTransform root, double scale) noexcept {
  for (double& place : root.position_m) place /= scale;
  return root;
}

Status check_pose(const Pose& pose, uint32_t joint_count, RootTransform* root) noexcept {
  if (pose.joints.size() != joint_count) {
    return make_status(StatusCode::kInvalidArgument, "pose: %zu joints given, the asset has %u",
                       pose.joints.size(), joint_count);
  }
  if (!pose.joints.data()) return make_status(StatusCode::kInvalidArgument, "pose: joints is a null pointer");
  for (size_t j = 0; j < pose.joints.size(); ++j) {
    if (Status status = check_joint(pose.joints[j], j); !status.ok()) return status;
  }
  return check_root(pose.root, root);
}

void joint_rotation(const Matrix34& joint, double out_xyzw[4]) noexcept {
  const Eigen::Matrix3d rotation = rotation_of(map(joint).leftCols<3>()).cast<double>();
  Eigen::Map<Eigen::Vector4d> out(out_xyzw);
  out = Quaterniond(rotation).normalized().coeffs();
}

JointParts split_joint(const Matrix34& joint) noexcept {
  const RowMatrix3 linear = map(joint).leftCols<3>();
  const RowMatrix3 rotation = rotation_of(linear);
  JointParts parts;
  Eigen::Map<Eigen::Vector4f>(parts.rotation_xyzw) = Eigen::Quaternionf(Eigen::Matrix3f(rotation)).coeffs();
  Eigen::Map<RowMatrix3>(parts.stretch) = rotation.transpose() * linear;
  Eigen::Map<Vector3f>(parts.translation_m) = map(joint).col(3);
  return parts;
}

PathWeights path_weights(double share, double dt_s, double dt_before_s, double dt_older_s) noexcept {
  constexpr double kAlike = 4;  // frame times further apart than this factor say little about each other
  constexpr double kFarthestBack = -1;  // the curve is not followed beyond c
  const auto alike = [&](double other_s) {
    return other_s > 0 && other_s * kAlike >= dt_s && dt_s * kAlike >= other_s;
  };
  if (!alike(dt_before_s) || share < kFarthestBack) return {share, 0, 0};
  // Newton's divided differences through b, a, c and d, in times of dt_s.
  const double before = dt_before_s / dt_s, curve = share * (share - 1) / (1 + before);
  PathWeights weights{share + curve, -curve / before, 0};
  if (!alike(dt_older_s)) return weights;
  const double older = dt_older_s / dt_s;
  const double bend = share * (share - 1) * (share + before) / (1 + before + older);
  weights.next += bend / (1 + before);
  weights.past -= bend * (1 / (before * (1 + before)) + 1 / (before * (before + older)));
  weights.older = bend / (older * (before + older));
  return weights;
}

Matrix34 joint_between(const JointParts& d, const JointParts& c, const JointParts& a, const JointParts& b,
                       const PathWeights& weights) noexcept {
  const auto next = static_cast<float>(weights.next), past = static_cast<float>(weights.past),
             older = static_cast<float>(weights.older);
  const auto along = [&](const auto& from_d, const auto& from_c, const auto& from_a, const auto& from_b) {
    return (from_a + next * (from_b - from_a) + past * (from_a - from_c) + older * (from_c - from_d)).eval();
  };
  using MapMatrix = Eigen::Map<const RowMatrix3>;
  using MapVector = Eigen::Map<const Vector3f>;
  const Quaterniond rotation_c = quaternion(c.rotation_xyzw), rotation_a = quaternion(a.rotation_xyzw);
  Vector3d turn = weights.next * logarithm(rotation_a.conjugate() * quaternion(b.rotation_xyzw)) +
                  weights.past * logarithm(rotation_c.conjugate() * rotation_a);
  if (weights.older != 0)
    turn += weights.older * logarithm(quaternion(d.rotation_xyzw).conjugate() * rotation_c);
  const Quaterniond rotation = rotation_a * exponential(turn);
  Matrix34 joint;
  Eigen::Map<RowMatrix34> out(&joint.m[0][0]);
  out.leftCols<3>() =
      rotation.normalized().toRotationMatrix().cast<float>() *
      along(MapMatrix(d.stretch), MapMatrix(c.stretch), MapMatrix(a.stretch), MapMatrix(b.stretch));
  out.col(3) = along(MapVector(d.translation_m), MapVector(c.translation_m), MapVector(a.translation_m),
                     MapVector(b.translation_m));
  return joint;
}

RootTransform root_between(const RootStep& older, const RootStep& before, const RootTransform& a,
                           const RootTransform& b, const PathWeights& weights) noexcept {
  const Quaterniond from = quaternion(a.rotation_xyzw);
  const Vector3d turn = weights.next * logarithm(from.conjugate() * quaternion(b.rotation_xyzw)) +
                        weights.past * Eigen::Map<const Vector3d>(before.turn) +
                        weights.older * Eigen::Map<const Vector3d>(older.turn);
  RootTransform root;
  Eigen::Map<Eigen::Vector4f>(root.rotation_xyzw) =
      (from * exponential(turn)).normalized().coeffs().cast<float>();
  for (int k = 0; k < 3; ++k) {
    root.position_m[k] = a.position_m[k] + weights.next * (b.position_m[k] - a.position_m[k]) +
                         weights.past * before.place_m[k] + weights.older * older.place_m[k];
  }
  root.scale = b.scale;
  return root;
}

void skin_matrices(std::span<const pack::JointRecord> records, const Matrix34* joints, float* skin) noexcept {
  for (size_t j = 0; j < records.size(); ++j) {
    const Eigen::Map<const RowMatrix34> inverse_bind(records[j].inverse_bind);
    Eigen::Map<RowMatrix34> out(skin + 12 * j);
    const auto joint = map(joints[j]);
    out.leftCols<3>().noalias() = joint.leftCols<3>() * inverse_bind.leftCols<3>();
    out.col(3) = joint.leftCols<3>() * inverse_bind.col(3) + joint.col(3);
  }
}

void bind_pose(std::span<const pack::JointRecord> records, Matrix34* joints) noexcept {
  for (size_t j = 0; j < records.size(); ++j) {
    const Eigen::Map<const RowMatrix34> inverse_bind(records[j].inverse_bind);
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topRows<3>() = inverse_bind.cast<double>();
    Eigen::Matrix4d bind;
    bool invertible = false;
    m.computeInverseWithCheck(bind, invertible, 1e-20);
    if (!invertible) bind.setIdentity();
    Eigen::Map<RowMatrix34>(&joints[j].m[0][0]) = bind.topRows<3>().cast<float>();
  }
}

}  // namespace sinew::world
