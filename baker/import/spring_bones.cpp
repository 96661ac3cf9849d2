// spring_bones.cpp  Spring bones that a VRM file states, version 0 and 1.
#include "baker/import/spring_bones.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

using tinygltf::Value;

constexpr size_t kMostSprings = 1000;

// Null where it is not there.
const Value& part(const Value& value, const char* key) {
  static const Value kNothing;
  return value.IsObject() && value.Has(key) ? value.Get(key) : kNothing;
}

std::vector<Value> list(const Value& value) {
  return value.IsArray() ? value.Get<Value::Array>() : std::vector<Value>{};
}

double number(const Value& value, double otherwise, double low, double high) {
  const double given = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  return std::isfinite(given) ? std::clamp(given, low, high) : otherwise;
}

std::string text(const Value& value) { return value.IsString() ? value.Get<std::string>() : ""; }

class SpringReader {
 public:
  SpringReader(const SceneGraph& graph, const std::vector<int>& joint_node, Source& source)
      : graph_(graph), source_(source), joint_of_node_(graph.nodes.size(), -1) {
    for (size_t j = joint_node.size(); j-- > 0;)  // the first of a node's joints
      joint_of_node_[static_cast<size_t>(joint_node[j])] = static_cast<int>(j);
  }

  void read_version_0(const Value& extension) {
    for (const Value& group : list(part(part(extension, "secondaryAnimation"), "boneGroups"))) {
      SpringBones spring = numbers_of(group, "stiffiness");  // the standard's spelling
      spring.name = text(part(group, "comment"));
      spring.collides = !list(part(group, "colliderGroups")).empty();
      note_direction(group, spring);
      for (const Value& bone : list(part(group, "bones"))) add(spring, joint_of(bone), -1);
    }
  }

  void read_version_1(const Value& extension) {
    for (const Value& stated : list(part(extension, "springs"))) {
      const std::vector<Value> joints = list(part(stated, "joints"));
      if (joints.empty()) continue;
      SpringBones spring = numbers_of(joints.front(), "stiffness");
      spring.name = text(part(stated, "name"));
      spring.collides = !list(part(stated, "colliderGroups")).empty();
      note_direction(joints.front(), spring);
      add(spring, joint_of(part(joints.front(), "node")), joint_of(part(joints.back(), "node")));
    }
  }

  std::vector<SpringBones> take() { return std::move(springs_); }

 private:
  static SpringBones numbers_of(const Value& value, const char* stiffness) {
    SpringBones spring;
    spring.stiffness = number(part(value, stiffness), 1, 0, 100);
    spring.gravity_power = number(part(value, "gravityPower"), 0, 0, 100);
    spring.drag_force = number(part(value, "dragForce"), 0.4, 0, 1);
    spring.hit_radius_m = number(part(value, "hitRadius"), 0.02, 0, 10);
    return spring;
  }

  // Version 0 has an object, version 1 a list; straight down in both where nothing is said.
  void note_direction(const Value& value, const SpringBones& spring) {
    const Value& direction = part(value, "gravityDir");
    const std::vector<Value> axes = list(direction);
    const double x = number(axes.size() == 3 ? axes[0] : part(direction, "x"), 0, -1, 1),
                 z = number(axes.size() == 3 ? axes[2] : part(direction, "z"), 0, -1, 1);
    if (spring.gravity_power > 0 && (x != 0 || z != 0))
      source_.note("spring '" + spring.name + "'", "its gravityDir is not straight down: taken as down");
  }

  int joint_of(const Value& node) const {
    if (!node.IsNumber()) return -1;
    const double index = node.GetNumberAsDouble();
    if (!(index >= 0 && index < static_cast<double>(graph_.node_of_file.size()))) return -1;
    return joint_of_node_[static_cast<size_t>(graph_.node_of_file[static_cast<size_t>(index)])];
  }

  void add(SpringBones spring, int root, int end) {
    if (springs_.size() >= kMostSprings)
      return source_.note("", "more than 1000 spring bones: the rest is left out");
    if (root < 0) return source_.note("a spring bone", "is no joint of the character's skin: left out");
    spring.root = root;
    spring.end = end == root ? -1 : end;
    springs_.push_back(std::move(spring));
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
  if (const auto at = model.extensions.find("VRM"); at != model.extensions.end())
    reader.read_version_0(at->second);
  if (const auto at = model.extensions.find("VRMC_springBone"); at != model.extensions.end())
    reader.read_version_1(at->second);
  return reader.take();
}

}  // namespace sinew::baker
