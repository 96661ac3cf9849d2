// joints.cpp  Skins of a file made into one list of joints.
#include "baker/import/joints.hpp"

#include <Eigen/LU>
#include <cmath>

#include "baker/import/pose.hpp"

namespace sinew::baker {
namespace {

constexpr const char* kMend = "the file is damaged; export it again";
constexpr size_t kMaxSkins = 1024;
constexpr size_t kMaxJoints = 65535;  // a vertex names its joints in 16 bits
constexpr double kSingular = 1e-12;   // relative determinant of a matrix that flattens space
constexpr double kSameBind = 1e-9;

std::string skin_name(const tinygltf::Model& model, int skin) {
  const std::string& name = model.skins[static_cast<size_t>(skin)].name;
  return "skin " + std::to_string(skin) + (name.empty() ? "" : " '" + name + "'");
}

bool invertible(const Matrix4& matrix) {
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double scale = linear.colwise().norm().prod();
  return matrix.allFinite() && scale > 0 && std::abs(linear.determinant()) > kSingular * scale;
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
    if (!invertible(binds[j]))
      source.refuse(where, "matrix " + std::to_string(j) + " is not finite or flattens space", kMend);
  }
  return binds;
}

class JointList {
 public:
  JointList(const SceneGraph& graph) : graph_(graph), at_node_(graph.nodes.size()) {}

  int add(int node, const Matrix4& inverse_bind) {
    for (int joint : at_node_[static_cast<size_t>(node)])
      if (inverse_bind_[static_cast<size_t>(joint)].isApprox(inverse_bind, kSameBind)) return joint;
    at_node_[static_cast<size_t>(node)].push_back(static_cast<int>(node_.size()));
    node_.push_back(node);
    inverse_bind_.push_back(inverse_bind);
    return at_node_[static_cast<size_t>(node)].back();
  }

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
  const SceneGraph& graph_;
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

// Scene-from-mesh by the skin's first root joint. Where the rest pose is the bind pose, every joint gives the
// same.
Matrix4 scene_from_mesh(const SceneGraph& graph, const std::vector<int>& nodes,
                        const std::vector<Matrix4>& binds) {
  std::vector<bool> in_skin(graph.nodes.size(), false), below(graph.nodes.size(), false);
  for (int node : nodes) in_skin[static_cast<size_t>(node)] = true;
  for (size_t i = 0; i < below.size(); ++i) {
    const int up = graph.nodes[i].parent;
    below[i] = up >= 0 && (in_skin[static_cast<size_t>(up)] || below[static_cast<size_t>(up)]);
  }
  for (size_t j = 0; j < nodes.size(); ++j) {
    const Matrix4 candidate = graph.rest[static_cast<size_t>(nodes[j])] * binds[j];
    if (!below[static_cast<size_t>(nodes[j])] && invertible(candidate)) return candidate;
  }
  return Matrix4::Identity();
}

void add_skin(const tinygltf::Model& model, const SceneGraph& graph, const AccessorReader& accessors,
              const Source& source, int skin, JointList& list, std::vector<int>& of_skin,
              Matrix4& bind_from_mesh) {
  const std::vector<int> nodes = skin_nodes(model, graph, skin, source);
  const std::vector<Matrix4> binds = read_inverse_binds(model, skin, accessors, source);
  bind_from_mesh = scene_from_mesh(graph, nodes, binds);
  const Matrix4 mesh_from_bind = bind_from_mesh.inverse();
  for (size_t j = 0; j < nodes.size(); ++j) of_skin.push_back(list.add(nodes[j], binds[j] * mesh_from_bind));
  if (list.size() > kMaxJoints)
    source.refuse(skin_name(model, skin),
                  "brings the joints to " + std::to_string(list.size()) + ", at most " +
                      std::to_string(kMaxJoints) + " are possible",
                  "split the character");
}

std::vector<bool> animated_nodes(const tinygltf::Model& model, const SceneGraph& graph) {
  std::vector<bool> animated(graph.nodes.size(), false);
  for (const tinygltf::Animation& animation : model.animations)
    for (const tinygltf::AnimationChannel& channel : animation.channels)
      if (channel.target_node >= 0 && static_cast<size_t>(channel.target_node) < animated.size())
        animated[static_cast<size_t>(graph.node_of_file[static_cast<size_t>(channel.target_node)])] = true;
  return animated;
}

// A mesh without a skin moves with the joint above it, if nothing in between can move; else its own node
// becomes a joint.
void attach(const SceneGraph& graph, const std::vector<bool>& animated, JointList& list,
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
  const Matrix4& rest = graph.rest[static_cast<size_t>(instance.node)];
  const std::string where = "node '" + graph.nodes[static_cast<size_t>(instance.node)].name + "'";
  if (!invertible(rest))
    source.refuse(where, "carries a mesh and its rest transform flattens space",
                  "give it a scale that is not zero");
  instance.joint = list.add(instance.node, rest.inverse());
  instance.bind_from_mesh = rest;
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
      instances.push_back({.node = index, .mesh = node.mesh, .skin = node.skin < 0 ? -1 : node.skin});
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
                   Source& source, std::vector<MeshInstance>& instances) {
  if (model.skins.size() > kMaxSkins)
    source.refuse("", "has " + std::to_string(model.skins.size()) + " skins, at most 1024 are possible",
                  "join the character's meshes");
  JointList list(graph);
  std::vector<std::vector<int>> of_skin(model.skins.size());
  std::vector<Matrix4> bind_from_mesh(model.skins.size(), Matrix4::Identity());
  for (MeshInstance& instance : instances) {
    if (instance.skin < 0) continue;
    const auto skin = static_cast<size_t>(instance.skin);
    if (of_skin[skin].empty())
      add_skin(model, graph, accessors, source, instance.skin, list, of_skin[skin], bind_from_mesh[skin]);
    instance.bind_from_mesh = bind_from_mesh[skin];
    instance.joint = list.nearest(instance.node);
    if (instance.joint < 0) instance.joint = of_skin[skin].front();
  }
  if (list.size() == 0)
    source.refuse("", "this file has no skin: no mesh of its scene is bound to joints",
                  "bind the mesh to a skeleton and export with skinning");
  const std::vector<bool> animated = animated_nodes(model, graph);
  for (MeshInstance& instance : instances)
    if (instance.skin < 0) attach(graph, animated, list, instance, source);
  return in_order(list, std::move(of_skin), instances);
}

}  // namespace sinew::baker
