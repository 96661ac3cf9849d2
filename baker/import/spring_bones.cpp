// spring_bones.cpp  Spring bones that a VRM file states, version 0 and 1.
#include "baker/import/spring_bones.hpp"

#include "baker/import/vrm_values.hpp"

namespace sinew::baker {
namespace {

using tinygltf::Value;

constexpr size_t kMostSprings = 1000;

std::string text(const Value& value) { return value.IsString() ? value.Get<std::string>() : ""; }

// What the standards give a joint that says nothing.
struct Defaults {
  const char* stiffness_key;
  double stiffness, gravity_power, drag_force;
};
constexpr Defaults kVersion0{"stiffiness", 1, 0, 0.4};  // the standard's spelling; the numbers are UniVRM's
constexpr Defaults kVersion1{"stiffness", 1, 0, 0.5};

class SpringReader {
 public:
  SpringReader(const SceneGraph& graph, const std::vector<int>& joint_node, Source& source)
      : graph_(graph), source_(source), joint_of_node_(graph.nodes.size(), -1) {
    for (size_t j = joint_node.size(); j-- > 0;)  // the first of a node's joints
      joint_of_node_[static_cast<size_t>(joint_node[j])] = static_cast<int>(j);
  }

  void read_version_0(const Value& extension) {
    for (const Value& group : list(part(part(extension, "secondaryAnimation"), "boneGroups"))) {
      SpringBones spring = numbers_of(group, kVersion0);
      spring.name = text(part(group, "comment"));
      spring.collides = !list(part(group, "colliderGroups")).empty();
      note_direction(group, spring);
      for (const Value& bone : list(part(group, "bones"))) {
        spring.root = joint_of(node_of(bone));
        add(spring);
      }
    }
  }

  void read_version_1(const Value& extension) {
    for (const Value& stated : list(part(extension, "springs"))) {
      const std::vector<Value> joints = list(part(stated, "joints"));
      if (joints.empty()) continue;
      SpringBones spring = numbers_of(joints.front(), kVersion1);
      spring.name = text(part(stated, "name"));
      spring.collides = !list(part(stated, "colliderGroups")).empty();
      if (joints.size() < 2) {
        source_.note("spring '" + spring.name + "'", "of one joint, which nothing swings: left out");
        continue;
      }
      note_direction(joints.front(), spring);
      note_other_numbers(joints, spring);
      set_bones(joints, spring);
      add(spring);
    }
  }

  std::vector<SpringBones> take() { return std::move(springs_); }

 private:
  static SpringBones numbers_of(const Value& value, const Defaults& defaults) {
    SpringBones spring;
    spring.stiffness = number(part(value, defaults.stiffness_key), defaults.stiffness, 0, 100);
    spring.gravity_power = number(part(value, "gravityPower"), defaults.gravity_power, 0, 100);
    spring.drag_force = number(part(value, "dragForce"), defaults.drag_force, 0, 1);
    return spring;
  }

  // The last joint is where the last bone ends, it has no numbers of its own.
  void note_other_numbers(const std::vector<Value>& joints, const SpringBones& first) {
    for (size_t i = 1; i + 1 < joints.size(); ++i) {
      const SpringBones own = numbers_of(joints[i], kVersion1);
      if (own.stiffness != first.stiffness || own.gravity_power != first.gravity_power ||
          own.drag_force != first.drag_force)
        return source_.note("spring '" + first.name + "'",
                            "its joints differ in numbers: the first one's are taken for all");
    }
  }

  // Two joints or more: all but the last swing, and each ends where the next one is. What is not in the skin
  // moves nothing, so that the last one that is ends the chain.
  void set_bones(const std::vector<Value>& joints, SpringBones& spring) {
    const auto node = [&](size_t i) { return node_of(part(joints[i], "node")); };
    size_t last = joints.size() - 2;
    while (last > 0 && joint_of(node(last)) < 0) --last;
    if (last < joints.size() - 2)
      source_.note("spring '" + spring.name + "'",
                   "its last joints are not in the skin: it ends at the last one that is");
    spring.root = joint_of(node(0));
    spring.end = joint_of(node(last));
    if (hangs_on(node(last + 1), node(last))) spring.end_node = node(last + 1);
  }

  bool hangs_on(int node, int above) const {
    if (node == above) return false;
    while (node >= 0 && node != above) node = graph_.nodes[static_cast<size_t>(node)].parent;
    return node >= 0;
  }

  // Version 0 has an object, version 1 a list; straight down in both where nothing is said.
  void note_direction(const Value& value, const SpringBones& spring) {
    const Value& direction = part(value, "gravityDir");
    const std::vector<Value> axes = list(direction);
    const double x = number(axes.size() == 3 ? axes[0] : part(direction, "x"), 0, -1, 1),
                 y = number(axes.size() == 3 ? axes[1] : part(direction, "y"), -1, -1, 1),
                 z = number(axes.size() == 3 ? axes[2] : part(direction, "z"), 0, -1, 1);
    if (spring.gravity_power > 0 && (x != 0 || y > 0 || z != 0))
      source_.note("spring '" + spring.name + "'", "its gravityDir is not straight down: taken as down");
  }

  int node_of(const Value& stated) const { return baker::node_of(graph_, stated); }

  int joint_of(int node) const { return node < 0 ? -1 : joint_of_node_[static_cast<size_t>(node)]; }

  void add(const SpringBones& spring) {
    if (springs_.size() >= kMostSprings)
      return source_.note("", "more than 1000 spring bones: the rest is left out");
    if (spring.root < 0)
      return source_.note("a spring bone", "is no joint of the character's skin: left out");
    springs_.push_back(spring);
  }

  const SceneGraph& graph_;
  Source& source_;
  std::vector<int> joint_of_node_;
  std::vector<SpringBones> springs_;
};

}  // namespace

std::vector<SpringBones> read_spring_bones(const tinygltf::Model& model, const SceneGraph& graph,
                                           const std::vector<int>& joint_node, Source& source) {
  SpringReader reader(graph, joint_node, source);
  read_vrm(model, reader);
  return reader.take();
}

}  // namespace sinew::baker
