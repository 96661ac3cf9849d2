// pose_blend.cpp  see pose_blend.hpp.
#include "samples/demo/pose_blend.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <vector>

namespace sinew::demo {
namespace {

using Affine = Eigen::Transform<float, 3, Eigen::Affine>;

Affine affine(const Matrix34& m) {
  Affine out = Affine::Identity();
  out.affine() = Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&m.m[0][0]);
  return out;
}

Matrix34 matrix(const Affine& affine) {
  Matrix34 out;
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&out.m[0][0]) = affine.affine();
  return out;
}

Affine mix(const Affine& a, const Affine& b, float t) {
  Eigen::Matrix3f turn_a, turn_b, stretch_a, stretch_b;
  a.computeRotationScaling(&turn_a, &stretch_a);
  b.computeRotationScaling(&turn_b, &stretch_b);
  const Eigen::Quaternionf turn = Eigen::Quaternionf(turn_a).slerp(t, Eigen::Quaternionf(turn_b));
  Affine out = Affine::Identity();
  out.linear() = turn * (stretch_a + t * (stretch_b - stretch_a));
  out.translation() = a.translation() + t * (b.translation() - a.translation());
  return out;
}

std::vector<Affine> to_parent(std::span<const pack::JointRecord> joints, std::span<const Matrix34> pose) {
  std::vector<Affine> out;
  out.reserve(joints.size());
  for (size_t j = 0; j < joints.size(); ++j) {
    const uint32_t parent = joints[j].parent;
    out.push_back(parent == pack::kNoIndex ? affine(pose[j])
                                           : affine(pose[parent]).inverse() * affine(pose[j]));
  }
  return out;
}

}  // namespace

void mix_near(std::span<const float> a, std::span<const float> b, float t, std::span<Matrix34> out) {
  for (size_t j = 0; j < out.size(); ++j) {
    float* entries = &out[j].m[0][0];
    for (size_t i = 0; i < 12; ++i) entries[i] = a[12 * j + i] + t * (b[12 * j + i] - a[12 * j + i]);
  }
}

void mix_far(std::span<const pack::JointRecord> joints, std::span<const Matrix34> a,
             std::span<const Matrix34> b, float t, std::span<Matrix34> out) {
  const std::vector<Affine> from = to_parent(joints, a), to = to_parent(joints, b);
  for (size_t j = 0; j < joints.size(); ++j) {
    const Affine local = mix(from[j], to[j], t);
    const uint32_t parent = joints[j].parent;
    out[j] = matrix(parent == pack::kNoIndex ? local : affine(out[parent]) * local);
  }
}

}  // namespace sinew::demo
