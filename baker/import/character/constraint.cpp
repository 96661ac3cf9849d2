// constraint.cpp  The formulas of VRMC_node_constraint 1.0.
#include "baker/import/character/constraint.hpp"

#include <algorithm>

#include "baker/import/character/pose.hpp"

namespace sinew::baker {
namespace {

using Eigen::Quaterniond;

class Follower {
 public:
  Follower(const std::vector<Node>& rest, std::vector<Node>& posed)
      : rest_(rest), posed_(posed), done_(rest.size(), false) {}

  void follow(size_t node) {
    const Constraint& constraint = rest_[node].constraint;
    if (done_[node]) return;
    done_[node] = true;
    if (constraint.kind == ConstraintKind::kNone) return;
    const auto source = static_cast<size_t>(constraint.source);
    follow(source);
    if (constraint.kind == ConstraintKind::kAim) follow_above(source), follow_above(node);
    posed_[node].rotation = rest_[node].rotation.slerp(constraint.weight, target(node, source));
  }

 private:
  void follow_above(size_t node) {
    for (int up = rest_[node].parent; up >= 0; up = rest_[static_cast<size_t>(up)].parent)
      follow(static_cast<size_t>(up));
  }

  // How a node above has been posed, in the scene.
  Matrix4 global(int node) const {
    Matrix4 matrix = Matrix4::Identity();
    for (; node >= 0; node = posed_[static_cast<size_t>(node)].parent)
      matrix = local_matrix(posed_[static_cast<size_t>(node)]) * matrix;
    return matrix;
  }

  Quaterniond target(size_t node, size_t source) const {
    const Quaterniond own = rest_[node].rotation, from = rest_[source].rotation;
    const Quaterniond turn = from.inverse() * posed_[source].rotation;
    const Vector3& axis = rest_[node].constraint.axis;
    switch (rest_[node].constraint.kind) {
      case ConstraintKind::kRoll: {
        const Quaterniond in_parent = from * turn * from.inverse();
        const Quaterniond in_own = own.inverse() * in_parent * own;
        const Quaterniond swing = Quaterniond::FromTwoVectors(axis, in_own * axis);
        return own * swing.inverse() * in_own;
      }
      case ConstraintKind::kAim: {
        const Matrix4 above = global(rest_[node].parent);
        const Quaterniond parent = rotation_of(above);
        const Vector3 place = (above * posed_[node].translation.homogeneous()).head<3>();
        const Vector3 to = global(static_cast<int>(source)).topRightCorner<3, 1>() - place;
        if (!(to.norm() > 0)) return own;
        const Quaterniond swing = Quaterniond::FromTwoVectors(parent * own * axis, to);
        return parent.inverse() * swing * parent * own;
      }
      default:
        return own * turn;
    }
  }

  static Quaterniond rotation_of(const Matrix4& matrix) {
    Eigen::Affine3d affine;
    affine.matrix() = matrix;
    const Eigen::Matrix3d rotation = affine.rotation();
    return rotation.allFinite() ? Quaterniond(rotation) : Quaterniond::Identity();
  }

  const std::vector<Node>& rest_;
  std::vector<Node>& posed_;
  std::vector<bool> done_;
};

}  // namespace

void follow_constraints(const std::vector<Node>& rest, std::vector<Node>& posed) {
  const auto is_constrained = [](const Node& node) { return node.constraint.kind != ConstraintKind::kNone; };
  if (std::ranges::none_of(rest, is_constrained)) return;
  Follower follower(rest, posed);
  for (size_t i = 0; i < rest.size(); ++i) follower.follow(i);
}

}  // namespace sinew::baker
