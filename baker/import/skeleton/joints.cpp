// joints.cpp  Skins of a file made into one list of joints.
#include "baker/import/skeleton/joints.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "baker/import/character/pose.hpp"
#include "baker/import/skeleton/bind_pose.hpp"

namespace sinew::baker {
namespace {

constexpr const char* kMend = "the file is damaged; export it again";
constexpr size_t kMaxSkins = 1024;
constexpr size_t kMaxJoints = 65535;  // a vertex names its joints in 16 bits
// Binds of one bone in several skins are one where they agree to the precision of floats, which exporters
// that quantise each mesh in a space of its own do not keep better.
constexpr double kSameTurn = 1e-5;   // of a bind's linear part
constexpr double kSamePlace = 1e-5;  // of the skeleton's reach
constexpr double kFarPlace = 1e-6;   // of the distance from the origin

std::string skin_name(const tinygltf::Model& model, int skin) {
  const std::string& name = model.skins[static_cast<size_t>(skin)].name;
  return "skin " + std::to_string(skin) + (name.empty() ? "" : " '" + name + "'");
}

std::vector<Matrix4> read_inverse_binds(const tinygltf::Model& model, int skin,
                                        const AccessorReader& accessors, const Source& source) {
  const tinygltf::Skin& file = model.skins[static_cast<size_t>(skin)];
  std::vector<Matrix4> binds(file.joints.size(), Matrix4::Identity());
  if (file.inverseBindMatrices < 0) return binds;
  const std::string where = skin_name(model, skin) + " inverseBindMatrices";
  const std::vector<double> values = accessors.numbers(file.inverseBindMatrices, 16, where);
  if (values.size() < binds.size() * 16)
    source.refuse(where,
                  "has " + std::to_string(values.size() / 16) + " matrices for " +
                      std::to_string(binds.size()) + " joints",
                  kMend);
  for (size_t j = 0; j < binds.size(); ++j) {
    binds[j] = Eigen::Map<const Matrix4>(values.data() + j * 16);
    binds[j].row(3) = Eigen::RowVector4d(0, 0, 0, 1);
    if (!is_invertible(binds[j]))
      source.refuse(where, "matrix " + std::to_string(j) + " is not finite or flattens space", kMend);
  }
  return binds;
}

// How far joints rest from each other.
double reach_of(const SceneGraph& graph, const std::vector<SkinBinds>& skins) {
  Eigen::AlignedBox3d box;
  for (const SkinBinds& skin : skins)
    for (const int node : skin.nodes)
      box.extend(Vector3(graph.rest[static_cast<size_t>(node)].topRightCorner<3, 1>()));
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

class JointList {
 public:
  JointList(const SceneGraph& graph, double reach)
      : graph_(graph), reach_(reach), at_node_(graph.nodes.size()) {}

  int add(int node, const Matrix4& inverse_bind) {
    for (int joint : at_node_[static_cast<size_t>(node)])
      if (is_same_bind(inverse_bind_[static_cast<size_t>(joint)].inverse(), inverse_bind.inverse()))
        return joint;
    at_node_[static_cast<size_t>(node)].push_back(static_cast<int>(node_.size()));
    node_.push_back(node);
    inverse_bind_.push_back(inverse_bind);
    return at_node_[static_cast<size_t>(node)].back();
  }

  bool has(int node) const { return !at_node_[static_cast<size_t>(node)].empty(); }

  // The first joint on the nearest node that carries one, from `node` upwards; -1 for none.
  int nearest(int node) const {
    for (; node >= 0; node = graph_.nodes[static_cast<size_t>(node)].parent)
      if (!at_node_[static_cast<size_t>(node)].empty()) return at_node_[static_cast<size_t>(node)].front();
    return -1;
  }

  size_t size() const { return node_.size(); }
  int node(int joint) const { return node_[static_cast<size_t>(joint)]; }
  const Matrix4& inverse_bind(int joint) const { return inverse_bind_[static_cast<size_t>(joint)]; }

  std::vector<int> parents() const {
    std::vector<int> above(graph_.nodes.size(), -1), parent;  // nearest joint strictly above a node
    for (size_t i = 0; i < above.size(); ++i) {
      const int up = graph_.nodes[i].parent;
      if (up < 0) continue;
      const auto& joints = at_node_[static_cast<size_t>(up)];
      above[i] = joints.empty() ? above[static_cast<size_t>(up)] : joints.front();
    }
    for (int node : node_) parent.push_back(above[static_cast<size_t>(node)]);
    return parent;
  }

 private:
  bool is_same_bind(const Matrix4& a, const Matrix4& b) const {
    const double turn = (a - b).topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
    const Vector3 from = a.topRightCorner<3, 1>(), to = b.topRightCorner<3, 1>();
    return turn <= kSameTurn * a.topLeftCorner<3, 3>().cwiseAbs().maxCoeff() &&
           (to - from).norm() <= kSamePlace * reach_ + kFarPlace * from.norm();
  }

  const SceneGraph& graph_;
  double reach_;
  std::vector<int> node_;
  std::vector<Matrix4> inverse_bind_;
  std::vector<std::vector<int>> at_node_;
};

std::vector<int> skin_nodes(const tinygltf::Model& model, const SceneGraph& graph, int skin,
                            const Source& source) {
  std::vector<int> nodes;
  std::vector<bool> seen(graph.nodes.size(), false);
  for (int joint : model.skins[static_cast<size_t>(skin)].joints) {
    const std::string name = "names node " + std::to_string(joint);
    if (joint < 0 || static_cast<size_t>(joint) >= graph.nodes.size())
      source.refuse(skin_name(model, skin), name + ", the file has " + std::to_string(graph.nodes.size()),
                    kMend);
    const int node = graph.node_of_file[static_cast<size_t>(joint)];
    if (seen[static_cast<size_t>(node)]) source.refuse(skin_name(model, skin), name + " twice", kMend);
    seen[static_cast<size_t>(node)] = true;
    nodes.push_back(node);
  }
  if (nodes.empty())
    source.refuse(skin_name(model, skin), "has no joints", "bind the mesh to a skeleton and export again");
  return nodes;
}

// Of all skins that a mesh of the scene has; the others stay empty.
std::vector<SkinBinds> read_skins(const tinygltf::Model& model, const SceneGraph& graph,
                                  const AccessorReader& accessors, const Source& source,
                                  const std::vector<MeshInstance>& instances) {
  std::vector<SkinBinds> skins(model.skins.size());
  for (const MeshInstance& instance : instances) {
    if (instance.skin < 0 || !skins[static_cast<size_t>(instance.skin)].nodes.empty()) continue;
    SkinBinds& skin = skins[static_cast<size_t>(instance.skin)];
    skin.nodes = skin_nodes(model, graph, instance.skin, source);
    skin.inverse_bind = read_inverse_binds(model, instance.skin, accessors, source);
    skin.mesh_node = instance.node;
    // Identities for several joints are what a skin without binds has.
    const auto is_identity = [](const Matrix4& bind) { return bind.isIdentity(0); };
    skin.states_binds = model.skins[static_cast<size_t>(instance.skin)].inverseBindMatrices >= 0 &&
                        (skin.nodes.size() == 1 || !std::ranges::all_of(skin.inverse_bind, is_identity));
  }
  return skins;
}

// Scene-from-mesh of each skin. One that rests as it was bound comes first, then the largest, so that others
// stand on its skeleton.
std::vector<Matrix4> bind_skins(const std::vector<SkinBinds>& skins, BindPose& pose) {
  std::vector<std::pair<bool, size_t>> rank;
  for (const SkinBinds& skin : skins)
    rank.emplace_back(skin.states_binds && pose.rests_as_bound(skin), skin.nodes.size());
  std::vector<size_t> order(skins.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](size_t s) { return rank[s]; });
  std::vector<Matrix4> from_mesh(skins.size(), Matrix4::Identity());
  for (const size_t s : order)
    if (skins[s].states_binds) from_mesh[s] = pose.add_skin(skins[s]);
  for (const size_t s : order)
    if (!skins[s].states_binds) pose.add_resting_skin(skins[s]);
  return from_mesh;
}

void add_joints(const SkinBinds& skin, const Matrix4& scene_from_mesh, const BindPose& pose,
                const std::string& name, const Source& source, JointList& list, std::vector<int>& of_skin) {
  const Matrix4 mesh_from_scene = scene_from_mesh.inverse();
  for (size_t j = 0; j < skin.nodes.size(); ++j) {
    Matrix4 joint_from_scene = skin.inverse_bind[j] * mesh_from_scene;
    if (!skin.states_binds) joint_from_scene = pose.of_node(skin.nodes[j]).inverse();
    of_skin.push_back(list.add(skin.nodes[j], joint_from_scene));
  }
  if (list.size() > kMaxJoints)
    source.refuse(name,
                  "brings the joints to " + std::to_string(list.size()) + ", at most " +
                      std::to_string(kMaxJoints) + " are possible",
                  "split the character");
}

// By clips, or as other nodes turn.
std::vector<bool> animated_nodes(const tinygltf::Model& model, const SceneGraph& graph) {
  std::vector<bool> animated(graph.nodes.size(), false);
  for (size_t i = 0; i < animated.size(); ++i)
    animated[i] = graph.nodes[i].constraint.kind != ConstraintKind::kNone;
  for (const tinygltf::Animation& animation : model.animations)
    for (const tinygltf::AnimationChannel& channel : animation.channels)
      if (channel.target_node >= 0 && static_cast<size_t>(channel.target_node) < animated.size())
        animated[static_cast<size_t>(graph.node_of_file[static_cast<size_t>(channel.target_node)])] = true;
  return animated;
}

// Nodes with a mesh or a joint of a skin at or below them: what moves them is seen.
std::vector<bool> carrying_nodes(const SceneGraph& graph, const JointList& list,
                                 const std::vector<MeshInstance>& instances) {
  std::vector<bool> carries(graph.nodes.size(), false);
  for (const MeshInstance& instance : instances)
    if (instance.skin < 0) carries[static_cast<size_t>(instance.node)] = true;
  for (size_t i = carries.size(); i-- > 0;) {
    if (list.has(static_cast<int>(i))) carries[i] = true;
    const int up = graph.nodes[i].parent;
    if (carries[i] && up >= 0) carries[static_cast<size_t>(up)] = true;
  }
  return carries;
}

// Nodes that springs move are joints as good as any.
void add_swinging(const SceneGraph& graph, const BindPose& pose, const std::vector<bool>& swinging,
                  const std::vector<MeshInstance>& instances, JointList& list) {
  const std::vector<bool> carries = carrying_nodes(graph, list, instances);
  for (size_t i = 0; i < swinging.size(); ++i) {
    const auto node = static_cast<int>(i);
    if (!swinging[i] || !carries[i] || list.has(node)) continue;
    const Matrix4 bound = pose.of_node(node);
    if (is_invertible(bound)) list.add(node, bound.inverse());
  }
}

// A mesh without a skin moves with the joint above it, if nothing in between can move; else its own node
// becomes a joint.
void attach(const SceneGraph& graph, const BindPose& pose, const std::vector<bool>& animated, JointList& list,
            MeshInstance& instance, const Source& source) {
  Matrix4 joint_from_mesh = Matrix4::Identity();
  int node = instance.node;
  const int joint = list.nearest(node);
  const int stop = joint < 0 ? -1 : list.node(joint);
  while (node != stop && node >= 0 && !animated[static_cast<size_t>(node)]) {
    joint_from_mesh = local_matrix(graph.nodes[static_cast<size_t>(node)]) * joint_from_mesh;
    node = graph.nodes[static_cast<size_t>(node)].parent;
  }
  if (joint >= 0 && node == stop) {
    instance.joint = joint;
    instance.bind_from_mesh = list.inverse_bind(joint).inverse() * joint_from_mesh;
    return;
  }
  const Matrix4 bound = pose.of_node(instance.node);
  const std::string where = "node '" + graph.nodes[static_cast<size_t>(instance.node)].name + "'";
  if (!is_invertible(bound))
    source.refuse(where, "carries a mesh and its rest transform flattens space",
                  "give it a scale that is not zero");
  instance.joint = list.add(instance.node, bound.inverse());
  instance.bind_from_mesh = bound;
}

// Joints in a parents-first order, everything that names them renumbered.
Joints in_order(const JointList& list, std::vector<std::vector<int>> of_skin,
                std::vector<MeshInstance>& instances) {
  const std::vector<int> parent = list.parents(), order = parents_first(parent);
  std::vector<int> place(order.size());
  Joints joints;
  for (int old : order) {
    place[static_cast<size_t>(old)] = static_cast<int>(joints.node.size());
    const int up = parent[static_cast<size_t>(old)];
    joints.node.push_back(list.node(old));
    joints.parent.push_back(up < 0 ? -1 : place[static_cast<size_t>(up)]);
    joints.inverse_bind.push_back(list.inverse_bind(old));
  }
  for (auto& skin : of_skin)
    for (int& joint : skin) joint = place[static_cast<size_t>(joint)];
  for (MeshInstance& instance : instances) instance.joint = place[static_cast<size_t>(instance.joint)];
  joints.of_skin = std::move(of_skin);
  return joints;
}

// Those that are no numbers count as zero.
std::vector<double> morph_weights(const tinygltf::Model& model, const tinygltf::Node& node) {
  std::vector<double> weights =
      node.weights.empty() ? model.meshes[static_cast<size_t>(node.mesh)].weights : node.weights;
  for (double& weight : weights)
    if (!std::isfinite(weight)) weight = 0;
  return weights;
}

}  // namespace

std::vector<MeshInstance> find_meshes(const tinygltf::Model& model, const SceneGraph& graph, Source& source) {
  std::vector<MeshInstance> instances;
  size_t outside = 0;
  for (size_t file = 0; file < model.nodes.size(); ++file) {
    const tinygltf::Node& node = model.nodes[file];
    const std::string where = "node " + std::to_string(file);
    if (node.mesh < 0) continue;
    if (static_cast<size_t>(node.mesh) >= model.meshes.size())
      source.refuse(
          where,
          "names mesh " + std::to_string(node.mesh) + ", the file has " + std::to_string(model.meshes.size()),
          kMend);
    if (node.skin >= 0 && static_cast<size_t>(node.skin) >= model.skins.size())
      source.refuse(
          where,
          "names skin " + std::to_string(node.skin) + ", the file has " + std::to_string(model.skins.size()),
          kMend);
    const int index = graph.node_of_file[file];
    if (graph.in_scene[static_cast<size_t>(index)])
      instances.push_back({.node = index,
                           .mesh = node.mesh,
                           .skin = node.skin < 0 ? -1 : node.skin,
                           .morph_weights = morph_weights(model, node)});
    else
      ++outside;
  }
  if (outside > 0)
    source.note("", std::to_string(outside) + " meshes are not in the scene that the file shows: left out");
  if (instances.empty())
    source.refuse("", "this file shows no mesh", "export the character's mesh together with its skeleton");
  return instances;
}

Joints read_joints(const tinygltf::Model& model, const SceneGraph& graph, const AccessorReader& accessors,
                   const std::vector<bool>& swinging, Source& source, std::vector<MeshInstance>& instances) {
  if (model.skins.size() > kMaxSkins)
    source.refuse("", "has " + std::to_string(model.skins.size()) + " skins, at most 1024 are possible",
                  "join the character's meshes");
  const std::vector<SkinBinds> skins = read_skins(model, graph, accessors, source, instances);
  BindPose pose(graph);
  const std::vector<Matrix4> scene_from_mesh = bind_skins(skins, pose);
  JointList list(graph, reach_of(graph, skins));
  std::vector<std::vector<int>> of_skin(skins.size());
  for (MeshInstance& instance : instances) {
    if (instance.skin < 0) continue;
    const auto skin = static_cast<size_t>(instance.skin);
    if (of_skin[skin].empty())
      add_joints(skins[skin], scene_from_mesh[skin], pose, skin_name(model, instance.skin), source, list,
                 of_skin[skin]);
    instance.bind_from_mesh = scene_from_mesh[skin];
    instance.in_joint_spaces = !skins[skin].states_binds;
    instance.joint = list.nearest(instance.node);
    if (instance.joint < 0) instance.joint = of_skin[skin].front();
  }
  if (list.size() == 0)
    source.refuse("", "this file has no skin: no mesh of its scene is bound to joints",
                  "bind the mesh to a skeleton and export with skinning");
  add_swinging(graph, pose, swinging, instances, list);
  const std::vector<bool> animated = animated_nodes(model, graph);
  for (MeshInstance& instance : instances)
    if (instance.skin < 0) attach(graph, pose, animated, list, instance, source);
  return in_order(list, std::move(of_skin), instances);
}

}  // namespace sinew::baker
