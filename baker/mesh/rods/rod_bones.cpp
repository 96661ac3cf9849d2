// rod_bones.cpp  The segments of a bone chain or tree in the bind pose.
#include "baker/mesh/rods/rod_bones.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "baker/common/bad_input.hpp"
#include "baker/import/character/pose.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

constexpr double kNoLength = 1e-6;   // of the character's height
constexpr double kSamePlace = 1e-3;  // of a segment: a child that begins so near its end begins there
constexpr double kThinnest = 0.01, kThickest = 2;  // radius, shares of a bone's length
constexpr double kBareRadius = 0.05;               // of a bone that moves no flesh

Vector3 place_of(const Character& character, int joint) {
  return character.inverse_bind[static_cast<size_t>(joint)].inverse().topRightCorner<3, 1>();
}

std::vector<bool> moves_flesh(const Character& character) {
  std::vector<bool> moves(character.joint_node.size(), false);
  for (const Influences& skin : character.skin)
    for (size_t k = 0; k < kInfluences; ++k)
      if (skin.weight[k] > 0) moves[static_cast<size_t>(skin.joint[k])] = true;
  return moves;
}

class Segmenter {
 public:
  Segmenter(const Character& character, const RodPlace& place) : character_(character), place_(place) {
    const size_t joints = character.joint_node.size();
    find_bones();
    below_.assign(joints, 0);
    for (size_t j = joints; j-- > 0;) {
      const int up = character.joint_parent[j];
      if (taken_[j] && up >= 0) below_[static_cast<size_t>(up)] += 1 + below_[j];
    }
    double low = 0, high = 0;
    for (const Vector3& p : character.positions) low = std::min(low, p.y()), high = std::max(high, p.y());
    no_length_m_ = kNoLength * (high - low);
  }

  std::vector<RodBone> run() {
    for (size_t j = 0; j < taken_.size(); ++j)
      if (taken_[j]) add(static_cast<int>(j));
    measure_radii();
    return std::move(bones_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw BadInput(character_.name + ": " + place_.where + ": " + what);
  }
  std::string quoted(int joint) const {
    return "'" + joint_name(character_, static_cast<size_t>(joint)) + "'";
  }

  // What lies between root and end, or below the root; weightless leaves are end sites.
  void find_bones() {
    taken_.assign(character_.joint_node.size(), false);
    const auto at = [&](int joint) { return static_cast<size_t>(joint); };
    taken_[at(place_.root)] = true;
    if (place_.end >= 0) {
      int joint = place_.end;
      for (; joint >= 0 && joint != place_.root; joint = character_.joint_parent[at(joint)])
        taken_[at(joint)] = true;
      if (joint < 0)
        refuse("its end " + quoted(place_.end) + " is not below its root " + quoted(place_.root));
      return;
    }
    for (size_t j = 0; j < taken_.size(); ++j) {
      const int up = character_.joint_parent[j];
      if (up >= 0 && taken_[at(up)]) taken_[j] = true;
    }
    const std::vector<bool> fleshy = moves_flesh(character_);
    std::vector<bool> leaf(taken_.size(), true);
    for (const int up : character_.joint_parent)
      if (up >= 0) leaf[at(up)] = false;
    for (size_t j = 0; j < taken_.size(); ++j)
      if (taken_[j] && leaf[j] && !fleshy[j] && static_cast<int>(j) != place_.root) taken_[j] = false;
  }

  // The child that goes on with the bone: a bone of the rod with most below it, else any joint.
  int main_child(int joint) const {
    int best = -1;
    const auto rank = [&](int j) {
      return taken_[static_cast<size_t>(j)] ? 1 + below_[static_cast<size_t>(j)] : 0;
    };
    for (size_t j = 0; j < taken_.size(); ++j)
      if (character_.joint_parent[j] == joint && (best < 0 || rank(static_cast<int>(j)) > rank(best)))
        best = static_cast<int>(j);
    return best;
  }

  // A node below the joint's that is no joint.
  bool end_site(int joint, const Vector3& begin, Vector3* out) const {
    const int node = character_.joint_node[static_cast<size_t>(joint)];
    for (size_t n = 0; n < character_.nodes.size(); ++n) {
      const bool is_joint = std::find(character_.joint_node.begin(), character_.joint_node.end(),
                                      static_cast<int>(n)) != character_.joint_node.end();
      if (character_.nodes[n].parent != node || is_joint) continue;
      const Matrix4 bind = character_.inverse_bind[static_cast<size_t>(joint)].inverse();
      *out = (bind * local_matrix(character_.nodes[n])).topRightCorner<3, 1>();
      return (*out - begin).norm() > no_length_m_;
    }
    return false;
  }

  // Of a node below the joint's, by the rest pose of the nodes between.
  Vector3 place_below(int joint, int node) const {
    const int top = character_.joint_node[static_cast<size_t>(joint)];
    Matrix4 to_node = Matrix4::Identity();
    for (; node >= 0 && node != top; node = character_.nodes[static_cast<size_t>(node)].parent) {
      const auto at = std::find(character_.joint_node.begin(), character_.joint_node.end(), node);
      if (at != character_.joint_node.end()) {
        joint = static_cast<int>(at - character_.joint_node.begin());
        break;
      }
      to_node = local_matrix(character_.nodes[static_cast<size_t>(node)]) * to_node;
    }
    const Matrix4 bind = character_.inverse_bind[static_cast<size_t>(joint)].inverse();
    return (bind * to_node).topRightCorner<3, 1>();
  }

  // As far on as the place says, away from the joint's parent.
  Vector3 tail_of(int joint, const Vector3& begin) const {
    const Vector3 along = begin - place_of(character_, character_.joint_parent[static_cast<size_t>(joint)]);
    if (place_.tail_m > 0 && along.norm() > no_length_m_) return begin + place_.tail_m * along.normalized();
    refuse("bone " + quoted(joint) +
           " is alone and nothing says where it ends; name a bone with bones below it, or add a bone at its "
           "tip in the file");
  }

  Vector3 end_of(int joint, int parent_bone, const Vector3& begin) const {
    if (joint == place_.end && (place_.end_place || place_.end_node >= 0)) {
      const Vector3 end = place_.end_place ? *place_.end_place : place_below(joint, place_.end_node);
      if ((end - begin).norm() > no_length_m_) return end;
      refuse("bone " + quoted(joint) + " begins where it ends: a segment has a length; end the rod above it");
    }
    const int child = main_child(joint);
    Vector3 site;
    if (child >= 0) {
      const Vector3 end = place_of(character_, child);
      if ((end - begin).norm() > no_length_m_) return end;
      refuse("bones " + quoted(joint) + " and " + quoted(child) +
             " begin at one position: a segment has a length; end the rod above them or move one");
    }
    if (end_site(joint, begin, &site)) return site;
    if (parent_bone < 0) return tail_of(joint, begin);
    const RodBone& parent = bones_[static_cast<size_t>(parent_bone)];
    return begin + parent.end - parent.begin;
  }

  int bone_of(int joint) const {
    for (size_t b = 0; b < bones_.size(); ++b)
      if (bones_[b].joint == joint) return static_cast<int>(b);
    return -1;
  }

  void add(int joint) {
    const int above =
        joint == place_.root ? -1 : bone_of(character_.joint_parent[static_cast<size_t>(joint)]);
    RodBone bone;
    bone.joint = joint;
    bone.parent = above;
    bone.begin = place_of(character_, joint);
    const bool beside = above >= 0 && !begins_at_end(bone.begin, above);
    if (above >= 0 && !beside) bone.begin = bones_[static_cast<size_t>(above)].end;
    bone.end = end_of(joint, above, bone.begin);  // of where it begins now: it may have come to its own end
    if (beside) bone.parent = add_link(above, bones_[static_cast<size_t>(above)].end, bone.begin);
    bones_.push_back(bone);
  }

  bool begins_at_end(const Vector3& begin, int bone) const {
    const RodBone& above = bones_[static_cast<size_t>(bone)];
    return (begin - above.end).norm() <= kSamePlace * (above.end - above.begin).norm();
  }

  int add_link(int parent, const Vector3& begin, const Vector3& end) {
    RodBone link;
    link.parent = parent;
    link.begin = begin;
    link.end = end;
    bones_.push_back(link);
    return static_cast<int>(bones_.size()) - 1;
  }

  // The mean distance of the vertices that a bone moves most from its axis.
  void measure_radii() {
    std::vector<double> sum(bones_.size(), 0), count(bones_.size(), 0);
    std::vector<int> bone_of_joint(character_.joint_node.size(), -1);
    for (size_t b = 0; b < bones_.size(); ++b)
      if (bones_[b].joint >= 0) bone_of_joint[static_cast<size_t>(bones_[b].joint)] = static_cast<int>(b);
    for (size_t v = 0; v < character_.skin.size(); ++v) {
      const int b = bone_of_joint[static_cast<size_t>(character_.skin[v].joint[0])];  // weights descend
      if (b < 0) continue;
      const RodBone& bone = bones_[static_cast<size_t>(b)];
      const Vector3 axis = bone.end - bone.begin, arm = character_.positions[v] - bone.begin;
      const double along = std::clamp(arm.dot(axis) / axis.squaredNorm(), 0.0, 1.0);
      sum[static_cast<size_t>(b)] += (arm - along * axis).norm();
      ++count[static_cast<size_t>(b)];
    }
    for (size_t b = 0; b < bones_.size(); ++b) {
      RodBone& bone = bones_[b];
      const double length = (bone.end - bone.begin).norm();
      if (count[b] > 0)
        bone.radius_m = bone_radius_m(sum[b] / count[b], length);
      else
        bone.radius_m =
            bone.parent >= 0 ? bones_[static_cast<size_t>(bone.parent)].radius_m : kBareRadius * length;
    }
  }

  const Character& character_;
  const RodPlace& place_;
  std::vector<bool> taken_;
  std::vector<int> below_;  // bones of the rod below a joint
  std::vector<RodBone> bones_;
  double no_length_m_ = 0;
};

}  // namespace

double bone_radius_m(double radius_m, double length_m) {
  return std::clamp(radius_m, kThinnest * length_m, kThickest * length_m);
}

std::vector<RodBone> segment_bones(const Character& character, const RodPlace& place) {
  return Segmenter(character, place).run();
}

}  // namespace sinew::baker
