// joint_above.cpp  see joint_above.hpp.
#include "baker/import/character/joint_above.hpp"

#include <Eigen/LU>
#include <cmath>

#include "baker/import/character/pose.hpp"

namespace sinew::baker {
namespace {

void shift(int& index) {
  if (index >= 0) ++index;
}

// A node before all others, above all of them.
void add_root_node(Character& character) {
  for (Node& node : character.nodes) {
    node.parent = node.parent < 0 ? 0 : node.parent + 1;
    shift(node.constraint.source);
  }
  for (int& node : character.joint_node) shift(node);
  for (Clip& clip : character.clips)
    for (Channel& channel : clip.channels) shift(channel.node);
  for (MeshSpan& mesh : character.meshes) shift(mesh.node);
  for (SpringBones& spring : character.springs) shift(spring.end_node);
  Node root;
  root.name = "root";
  character.nodes.insert(character.nodes.begin(), root);
}

void add_first_joint(Character& character, int node, const Matrix4& inverse_bind) {
  for (int& parent : character.joint_parent) shift(parent);
  for (Influences& skin : character.skin)
    for (size_t k = 0; k < kInfluences; ++k)
      if (skin.weight[k] > 0) ++skin.joint[k];
  for (SpringBones& spring : character.springs) {
    shift(spring.root), shift(spring.end);
    for (auto& [bone, numbers] : spring.of_joints) shift(bone);
  }
  for (BodyCollider& collider : character.colliders) shift(collider.joint);
  character.joint_node.insert(character.joint_node.begin(), node);
  character.joint_parent.insert(character.joint_parent.begin(), -1);
  character.inverse_bind.insert(character.inverse_bind.begin(), inverse_bind);
}

bool is_below(const Character& character, int node, int above) {
  while (node >= 0 && node != above) node = character.nodes[static_cast<size_t>(node)].parent;
  return node >= 0;
}

}  // namespace

void add_joint_above(Character& character, int joint) {
  const auto index = static_cast<size_t>(joint);
  int node = character.joint_node[index];
  int above = character.nodes[static_cast<size_t>(node)].parent;
  // What holds it was bound as it stands to the bone at rest; a new root moves with the instance alone.
  // One that rests at a scale of zero does not tell.
  const Matrix4 local = local_matrix(character.nodes[static_cast<size_t>(node)]);
  const bool flat = !(std::abs(local.topLeftCorner<3, 3>().determinant()) > 1e-12);
  Matrix4 inverse_bind =
      flat ? character.inverse_bind[index] : Matrix4(local * character.inverse_bind[index]);
  if (above < 0) {
    inverse_bind = character.character_from_scene.inverse();
    add_root_node(character);
    above = 0;
  }
  add_first_joint(character, above, inverse_bind);
  for (size_t j = 1; j < character.joint_node.size(); ++j)
    if (character.joint_parent[j] < 0 && is_below(character, character.joint_node[j], above))
      character.joint_parent[j] = 0;
}

}  // namespace sinew::baker
