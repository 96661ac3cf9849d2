// node_bend.cpp  The fourth root of a rotation, by quaternions and without an angle.
#include "tissue/node_bend.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tissue/modal_base.hpp"

namespace sinew::tissue {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

// cos of half the bend: below kFading the bend fades out, below kGone it is nothing.
constexpr float kFading = 0.4f, kGone = 0.1f;

// The vector part of the quaternion of turn^(1/4); its scalar part is positive.
Vector3f quarter_of(const Matrix3f& turn) {
  const float w = std::sqrt(std::max(1 + turn.trace(), 0.0f)) / 2;
  if (!(w > kGone)) return Vector3f::Zero();
  const Vector3f half_sine =
      Vector3f{turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)} / (4 * w);
  // The root of a unit quaternion (v, w) is (v, w + 1) / sqrt(2 + 2 w).
  const float root = std::sqrt(2 + 2 * w);
  const float quarter = std::sqrt(2 + 2 * (w + 1) / root);
  return std::min(1.0f, (w - kGone) / (kFading - kGone)) / (root * quarter) * half_sine;
}

// 2 asin(|v|) v / |v| by its series; |v| <= sin(pi / 8).
Vector3f rotation_vector(const Vector3f& v) {
  const float s = v.squaredNorm();
  return v * (2 + s * (1.0f / 3 + s * (3.0f / 20 + s * (5.0f / 56 + s * (35.0f / 576 + s * 63.0f / 1408)))));
}

}  // namespace

void share_bend(uint32_t anchor, uint32_t count, NodePose* nodes) noexcept {
  const Matrix3f held = Eigen::Map<const Rows33>(nodes[anchor].rotation);
  for (uint32_t i = 0; i < count; ++i) {
    Eigen::Map<Rows33> rotation(nodes[i].rotation);
    const Vector3f v = quarter_of(held.transpose() * rotation);
    const Eigen::Quaternionf back(std::sqrt(1 - v.squaredNorm()), -v.x(), -v.y(), -v.z());
    rotation = (rotation * back.toRotationMatrix()).eval();
    Eigen::Map<Vector3f>(nodes[i].bend) = rotation_vector(v);
  }
}

void along_flesh(const NodePose& node, const float v[3], float out[3]) noexcept {
  turn_back(node.bend, v, out);
}

void along_frame(const NodePose& node, const float v[3], float out[3]) noexcept {
  const float back[3] = {-node.bend[0], -node.bend[1], -node.bend[2]};
  turn_back(back, v, out);
}

}  // namespace sinew::tissue
