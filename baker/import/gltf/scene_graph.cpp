// scene_graph.cpp  Node transforms, parents, order.
#include "baker/import/gltf/scene_graph.hpp"

#include <cmath>
#include <functional>
#include <queue>

#include "baker/import/character/pose.hpp"

namespace sinew::baker {
namespace {

constexpr const char* kMend = "the file is damaged; export it again";
constexpr size_t kMaxNodes = 65536;      // far above any character; bounds the walks up the tree
constexpr double kUnitTolerance = 1e-2;  // quaternions off by more were not written as rotations

std::string node_name(const tinygltf::Model& model, size_t index) {
  const std::string& name = model.nodes[index].name;
  return "node " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

// The numbers of a transform property, or the default where the file has none.
Eigen::VectorXd property(const std::vector<double>& values, const Eigen::VectorXd& otherwise,
                         const std::string& where, const Source& source) {
  if (values.empty()) return otherwise;
  if (static_cast<Eigen::Index>(values.size()) != otherwise.size())
    source.refuse(
        where,
        "has " + std::to_string(values.size()) + " numbers instead of " + std::to_string(otherwise.size()),
        kMend);
  for (double value : values)
    if (!std::isfinite(value)) source.refuse(where, "is not finite", kMend);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), otherwise.size());
}

Eigen::Quaterniond unit_rotation(const Eigen::VectorXd& xyzw, const std::string& where, Source& source) {
  const double norm = xyzw.norm();
  if (norm < 1e-9) {
    source.note(where, "rotation of length zero: not turned");
    return Eigen::Quaterniond::Identity();
  }
  if (std::abs(norm - 1) > kUnitTolerance) source.note(where, "rotation was not of unit length: normalised");
  return Eigen::Quaterniond(xyzw[3] / norm, xyzw[0] / norm, xyzw[1] / norm, xyzw[2] / norm);
}

Node read_node(const tinygltf::Model& model, size_t index, Source& source) {
  const tinygltf::Node& file = model.nodes[index];
  const std::string where = node_name(model, index);
  Node node;
  node.name = file.name.empty() ? "node_" + std::to_string(index) : file.name;
  if (!file.matrix.empty()) {
    const Eigen::VectorXd columns =
        property(file.matrix, Eigen::VectorXd::Zero(16), where + " matrix", source);
    node.has_matrix = true;
    node.matrix = Eigen::Map<const Matrix4>(columns.data());
    node.matrix.row(3) = Eigen::RowVector4d(0, 0, 0, 1);  // glTF transforms are affine
    return node;
  }
  node.translation = property(file.translation, Vector3::Zero(), where + " translation", source);
  node.rotation = unit_rotation(
      property(file.rotation, Eigen::Vector4d(0, 0, 0, 1), where + " rotation", source), where, source);
  node.scale = property(file.scale, Vector3::Ones(), where + " scale", source);
  return node;
}

std::vector<int> read_parents(const tinygltf::Model& model, const Source& source) {
  std::vector<int> parent(model.nodes.size(), -1);
  for (size_t i = 0; i < model.nodes.size(); ++i)
    for (int child : model.nodes[i].children) {
      if (child < 0 || static_cast<size_t>(child) >= parent.size())
        source.refuse(node_name(model, i),
                      "names child " + std::to_string(child) + ", the file has " +
                          std::to_string(parent.size()) + " nodes",
                      kMend);
      if (parent[static_cast<size_t>(child)] != -1)
        source.refuse(node_name(model, static_cast<size_t>(child)), "is the child of two nodes", kMend);
      parent[static_cast<size_t>(child)] = static_cast<int>(i);
    }
  return parent;
}

// Nodes of the scene that the file shows first; all of them where it names none.
std::vector<bool> nodes_in_scene(const tinygltf::Model& model, const SceneGraph& graph, Source& source) {
  if (model.scenes.empty()) return std::vector<bool>(graph.nodes.size(), true);
  size_t scene = model.defaultScene < 0 ? 0 : static_cast<size_t>(model.defaultScene);
  if (scene >= model.scenes.size()) {
    source.note("scene", "the file names scene " + std::to_string(scene) +
                             ", which it does not have: scene 0 is taken");
    scene = 0;
  }
  std::vector<bool> in_scene(graph.nodes.size(), false);
  for (int root : model.scenes[scene].nodes) {
    if (root < 0 || static_cast<size_t>(root) >= graph.nodes.size())
      source.refuse(
          "scene " + std::to_string(scene),
          "names node " + std::to_string(root) + ", the file has " + std::to_string(graph.nodes.size()),
          kMend);
    in_scene[static_cast<size_t>(graph.node_of_file[static_cast<size_t>(root)])] = true;
  }
  for (size_t i = 0; i < graph.nodes.size(); ++i)
    if (graph.nodes[i].parent >= 0 && in_scene[static_cast<size_t>(graph.nodes[i].parent)])
      in_scene[i] = true;
  return in_scene;
}

}  // namespace

std::vector<int> parents_first(const std::vector<int>& parent) {
  std::vector<std::vector<int>> children(parent.size());
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;
  for (size_t i = 0; i < parent.size(); ++i) {
    if (parent[i] < 0)
      ready.push(static_cast<int>(i));
    else
      children[static_cast<size_t>(parent[i])].push_back(static_cast<int>(i));
  }
  std::vector<int> order;
  while (!ready.empty()) {
    order.push_back(ready.top());
    ready.pop();
    for (int child : children[static_cast<size_t>(order.back())]) ready.push(child);
  }
  return order;
}

SceneGraph read_scene_graph(const tinygltf::Model& model, Source& source) {
  if (model.nodes.size() > kMaxNodes)
    source.refuse("", "has " + std::to_string(model.nodes.size()) + " nodes, at most 65536 are possible",
                  "export the character alone");
  const std::vector<int> parent = read_parents(model, source);
  const std::vector<int> order = parents_first(parent);
  SceneGraph graph;
  graph.node_of_file.assign(parent.size(), -1);
  for (int file : order) {
    graph.node_of_file[static_cast<size_t>(file)] = static_cast<int>(graph.nodes.size());
    Node node = read_node(model, static_cast<size_t>(file), source);
    const int above = parent[static_cast<size_t>(file)];
    node.parent = above < 0 ? -1 : graph.node_of_file[static_cast<size_t>(above)];
    graph.nodes.push_back(std::move(node));
  }
  for (size_t i = 0; i < parent.size(); ++i)
    if (graph.node_of_file[i] < 0)
      source.refuse(node_name(model, i), "is its own ancestor", "break the cycle of children");
  graph.in_scene = nodes_in_scene(model, graph, source);
  graph.rest = global_matrices(graph.nodes, Matrix4::Identity());
  return graph;
}

}  // namespace sinew::baker
