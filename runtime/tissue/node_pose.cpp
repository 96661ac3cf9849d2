// node_pose.cpp  Blends skin matrices and takes what turns out of them.
#include "tissue/node_pose.hpp"

#include <Eigen/Geometry>

namespace sinew::tissue {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
using Rows34 = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

Rows34 blended(const pack::SkinRecord& skin, const float* matrices) {
  Rows34 sum = Rows34::Zero();
  for (uint32_t k = 0; k < pack::kInfluences && skin.weight[k] > 0; ++k) {
    sum += skin.weight[k] * Eigen::Map<const Rows34>(matrices + size_t{12} * skin.joint[k]);
  }
  return sum;
}

Vector3f unit_or(const Vector3f& v, const Vector3f& otherwise) {
  constexpr float kCollapsed = 1e-6f;
  const float length = v.norm();
  return length > kCollapsed ? Vector3f(v / length) : otherwise;
}

Matrix3f rotation_of(const Matrix3f& m) {
  const Vector3f x = unit_or(m.col(0), Vector3f::UnitX());
  const Vector3f y = unit_or(m.col(1) - x * x.dot(m.col(1)), x.unitOrthogonal());
  Matrix3f rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

}  // namespace

void pose_nodes(std::span<const pack::NodeRecord> nodes, const float* skin, const float root_rotation_xyzw[4],
                NodePose* out) noexcept {
  const Matrix3f root = Eigen::Quaternionf(root_rotation_xyzw[3], root_rotation_xyzw[0],
                                           root_rotation_xyzw[1], root_rotation_xyzw[2])
                            .normalized()
                            .toRotationMatrix();
  for (const pack::NodeRecord& node : nodes) {
    const Rows34 matrix = blended(node.skin, skin);
    const Eigen::Map<const Vector3f> place(node.position_m);
    Eigen::Map<Vector3f>(out->place_m) = root * (matrix.leftCols<3>() * place + matrix.col(3));
    Eigen::Map<Rows33>(out->rotation) = root * rotation_of(matrix.leftCols<3>());
    Eigen::Map<Vector3f>(out->bend).setZero();
    ++out;
  }
}

}  // namespace sinew::tissue
