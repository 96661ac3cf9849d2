// pose.cpp  Clips sampled as glTF 2.0 prescribes (3.11, appendix C), and linear blend skinning.
#include "baker/import/character/pose.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "baker/import/character/constraint.hpp"

namespace sinew::baker {
namespace {

using Eigen::Quaterniond;
using Eigen::VectorXd;
using Key = Eigen::Map<const VectorXd>;

// What a channel's samplers need: the keys on both sides of t and how far between them it is.
struct Span {
  size_t left = 0, right = 0;
  double share = 0, length_s = 0;
};

Span find_span(const std::vector<double>& times, double t) {
  if (t <= times.front()) return {};
  if (t >= times.back()) return {times.size() - 1, times.size() - 1, 0, 0};
  const auto right = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  const double length = times[right] - times[right - 1];
  return {right - 1, right, (t - times[right - 1]) / length, length};
}

Quaterniond as_rotation(const VectorXd& xyzw) {
  return Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized();
}
VectorXd as_values(const Quaterniond& rotation) { return rotation.coeffs(); }

// Eigen's slerp takes the shorter arc, as appendix C.4 wants.
VectorXd linear(const Channel& channel, const Key& left, const Key& right, double share) {
  if (channel.path != Path::kRotation) return left + share * (right - left);
  return as_values(as_rotation(left).slerp(share, as_rotation(right)));
}

// Appendix C.5; tangents are a second's, so they are scaled by the span.
VectorXd cubic(const Channel& channel, const Span& span, Eigen::Index width) {
  const auto part = [&](size_t key, Eigen::Index which) {
    return Key(channel.values.data() + (static_cast<Eigen::Index>(key) * 3 + which) * width, width);
  };
  if (span.left == span.right) return part(span.left, 1);
  const double s = span.share, s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * part(span.left, 1) + span.length_s * (s3 - 2 * s2 + s) * part(span.left, 2) +
         (-2 * s3 + 3 * s2) * part(span.right, 1) + span.length_s * (s3 - s2) * part(span.right, 0);
}

VectorXd sample(const Channel& channel, double t) {
  const Eigen::Index width = channel.path == Path::kRotation ? 4 : 3;
  const Span span = find_span(channel.times_s, t);
  if (channel.interpolation == Interpolation::kCubicSpline) return cubic(channel, span, width);
  const auto key = [&](size_t index) {
    return Key(channel.values.data() + static_cast<Eigen::Index>(index) * width, width);
  };
  if (channel.interpolation == Interpolation::kStep || span.left == span.right) return key(span.left);
  return linear(channel, key(span.left), key(span.right), span.share);
}

void apply(const Channel& channel, double t, Node& node) {
  const VectorXd value = sample(channel, t);
  switch (channel.path) {
    case Path::kTranslation:
      node.translation = value;
      break;
    case Path::kRotation:
      node.rotation = as_rotation(value);
      break;
    case Path::kScale:
      node.scale = value;
      break;
  }
}

}  // namespace

Matrix4 local_matrix(const Node& node) {
  if (node.has_matrix) return node.matrix;
  Matrix4 matrix = Matrix4::Identity();
  matrix.topLeftCorner<3, 3>() = node.rotation.toRotationMatrix() * node.scale.asDiagonal();
  matrix.topRightCorner<3, 1>() = node.translation;
  return matrix;
}

std::vector<Matrix4> global_matrices(const std::vector<Node>& nodes, const Matrix4& root) {
  std::vector<Matrix4> global(nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Matrix4& above = nodes[i].parent < 0 ? root : global[static_cast<size_t>(nodes[i].parent)];
    global[i] = above * local_matrix(nodes[i]);
  }
  return global;
}

std::vector<Matrix4> joint_matrices(const Character& character, const Clip* clip, double t_s) {
  std::vector<Node> nodes = character.nodes;
  if (clip)
    for (const Channel& channel : clip->channels)
      apply(channel, t_s, nodes[static_cast<size_t>(channel.node)]);
  follow_constraints(character.nodes, nodes);
  const std::vector<Matrix4> global = global_matrices(nodes, character.character_from_scene);
  std::vector<Matrix4> joints;
  joints.reserve(character.joint_node.size());
  for (int node : character.joint_node) joints.push_back(global[static_cast<size_t>(node)]);
  return joints;
}

double height_m(const Character& character) {
  if (character.positions.empty()) return 0;
  const auto [low, high] =
      std::ranges::minmax_element(character.positions, {}, [](const Vector3& p) { return p.y(); });
  return high->y() - low->y();
}

std::vector<Matrix4> bind_matrices(const Character& character) {
  std::vector<Matrix4> joints;
  for (const Matrix4& inverse_bind : character.inverse_bind) joints.push_back(inverse_bind.inverse());
  return joints;
}

std::vector<Vector3> skin_positions(const Character& character, const std::vector<Matrix4>& joints) {
  std::vector<Eigen::Matrix<double, 3, 4>> skin(joints.size());
  for (size_t j = 0; j < joints.size(); ++j) skin[j] = (joints[j] * character.inverse_bind[j]).topRows<3>();
  std::vector<Vector3> posed(character.positions.size(), Vector3::Zero());
  for (size_t v = 0; v < posed.size(); ++v) {
    const Eigen::Vector4d bind = character.positions[v].homogeneous();
    const Influences& influences = character.skin[v];
    for (size_t k = 0; k < kInfluences && influences.weight[k] > 0; ++k)
      posed[v] += influences.weight[k] * (skin[static_cast<size_t>(influences.joint[k])] * bind);
  }
  return posed;
}

}  // namespace sinew::baker
