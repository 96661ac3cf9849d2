// bones.cpp  Bones from joints: which child goes on with a chain, thickness of flesh, limb segments.
#include "baker/mesh/anatomy/bones.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace sinew::baker {
namespace {

constexpr double kMovesVertex = 0.2;  // smaller shares of skin weight only smooth a seam
constexpr double kTipLength = 0.5;  // a last bone, which has no child to end at, as a share of the one before

std::vector<int> subtree_sizes(const Character& character) {
  std::vector<int> size(character.joint_node.size(), 1);
  for (size_t j = size.size(); j-- > 0;)
    if (character.joint_parent[j] >= 0) size[static_cast<size_t>(character.joint_parent[j])] += size[j];
  return size;
}

Vector3 direction(const Vector3& from, const Vector3& to) {
  const Vector3 along = to - from;
  return along.norm() > 1e-9 ? Vector3(along.normalized()) : Vector3::Zero();
}

// The child that lies straightest ahead and carries most of what follows: the spine goes on to the neck, not
// to an arm.
std::vector<int> find_main_children(const Character& character, const std::vector<Vector3>& head,
                                    const std::vector<bool>& helper) {
  const std::vector<int> size = subtree_sizes(character);
  std::vector<int> child(head.size(), -1);
  std::vector<double> best(head.size(), -std::numeric_limits<double>::infinity());
  for (size_t j = 0; j < head.size(); ++j) {
    if (character.joint_parent[j] < 0 || helper[j]) continue;
    const auto up = static_cast<size_t>(character.joint_parent[j]);
    const int above = character.joint_parent[up];
    const Vector3 ahead =
        above < 0 ? Vector3::UnitY() : direction(head[static_cast<size_t>(above)], head[up]);
    const double score = direction(head[up], head[j]).dot(ahead) + static_cast<double>(size[j]) / size[up];
    if (score > best[up]) best[up] = score, child[up] = static_cast<int>(j);
  }
  return child;
}

double distance_to_segment(const Vector3& point, const Vector3& a, const Vector3& b) {
  const Vector3 along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - a - share * along).norm();
}

}  // namespace

Bones find_bones(const Character& character, const std::vector<bool>& helpers) {
  Bones bones;
  bones.helper = helpers;
  bones.helper.resize(character.inverse_bind.size(), false);
  for (const Matrix4& bind : character.inverse_bind)
    bones.head.push_back(bind.inverse().topRightCorner<3, 1>());
  bones.main_child = find_main_children(character, bones.head, bones.helper);
  bones.tail = bones.head;
  for (size_t j = 0; j < bones.head.size(); ++j) {
    const int up = character.joint_parent[j];
    if (up < 0) bones.helper[j] = false;
    if (bones.helper[j]) {
      bones.head[j] = bones.head[static_cast<size_t>(up)];
      bones.tail[j] = bones.tail[static_cast<size_t>(up)];
      continue;
    }
    if (bones.main_child[j] >= 0)
      bones.tail[j] = bones.head[static_cast<size_t>(bones.main_child[j])];
    else if (up >= 0)
      bones.tail[j] += kTipLength * (bones.head[j] - bones.head[static_cast<size_t>(up)]);
  }
  return bones;
}

std::vector<double> flesh_thickness(const Character& character, const Bones& bones) {
  std::vector<double> thickness;
  for (size_t v = 0; v < character.positions.size(); ++v) {
    double nearest = std::numeric_limits<double>::infinity();
    const Influences& skin = character.skin[v];
    for (size_t k = 0; k < kInfluences; ++k) {
      if (k > 0 && skin.weight[k] < kMovesVertex) break;
      const auto joint = static_cast<size_t>(skin.joint[k]);
      nearest = std::min(nearest,
                         distance_to_segment(character.positions[v], bones.head[joint], bones.tail[joint]));
    }
    thickness.push_back(nearest);
  }
  return thickness;
}

std::vector<int> limb_segments(const Character& character, const Bones& bones, double max_length_m) {
  std::vector<int> segment(bones.head.size());
  std::vector<double> length(bones.head.size(), 0);
  int count = 0;
  for (size_t j = 0; j < segment.size(); ++j) {
    const int up = character.joint_parent[j];
    const double own = bones.helper[j] ? 0 : (bones.tail[j] - bones.head[j]).norm();
    const bool goes_on = up >= 0 && bones.main_child[static_cast<size_t>(up)] == static_cast<int>(j) &&
                         length[static_cast<size_t>(up)] + own <= max_length_m;
    segment[j] = bones.helper[j] ? -1 : goes_on ? segment[static_cast<size_t>(up)] : count++;
    length[j] = goes_on ? length[static_cast<size_t>(up)] + own : own;
  }
  return segment;
}

double bind_height(const Character& character) {
  double low = character.positions.front().y(), high = low;
  for (const Vector3& place : character.positions)
    low = std::min(low, place.y()), high = std::max(high, place.y());
  return high - low;
}

}  // namespace sinew::baker
