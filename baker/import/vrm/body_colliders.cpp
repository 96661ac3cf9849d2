// body_colliders.cpp  What a VRM file lets its spring bones collide with, version 0 and 1.
#include "baker/import/gltf/vrm_values.hpp"
#include "baker/import/vrm/spring_bones.hpp"

namespace sinew::baker {
namespace {

using tinygltf::Value;

constexpr size_t kMostColliders = 1000;
constexpr double kFarthest = 1000, kLargest = 100;  // of an offset and a radius, in the file's units

// Version 0 has an object, told in Unity's left-handed space; version 1 a list.
Vector3 offset_of(const Value& value) {
  const std::vector<Value> axes = list(value);
  if (axes.size() == 3)
    return {number(axes[0], 0, -kFarthest, kFarthest), number(axes[1], 0, -kFarthest, kFarthest),
            number(axes[2], 0, -kFarthest, kFarthest)};
  return {number(part(value, "x"), 0, -kFarthest, kFarthest),
          number(part(value, "y"), 0, -kFarthest, kFarthest),
          -number(part(value, "z"), 0, -kFarthest, kFarthest)};
}

class ColliderReader {
 public:
  ColliderReader(const SceneGraph& graph, const std::vector<int>& joint_node, Source& source)
      : graph_(graph), joint_node_(joint_node), source_(source) {}

  void read_version_0(const Value& extension) {
    int index = 0;
    for (const Value& group : list(part(part(extension, "secondaryAnimation"), "colliderGroups"))) {
      for (const Value& sphere : list(part(group, "colliders"))) {
        const Vector3 middle = offset_of(part(sphere, "offset"));
        add(part(group, "node"), middle, middle, part(sphere, "radius"), {index});
      }
      ++index;
    }
  }

  void read_version_1(const Value& extension) {
    const std::vector<std::vector<int>> groups = groups_of_colliders(extension);
    size_t index = 0;
    for (const Value& collider : list(part(extension, "colliders"))) {
      const Value& shape = part(collider, "shape");
      const Value &sphere = part(shape, "sphere"), &capsule = part(shape, "capsule");
      const Value& round = capsule.IsObject() ? capsule : sphere;
      const Vector3 from = offset_of(part(round, "offset"));
      add(part(collider, "node"), from, capsule.IsObject() ? offset_of(part(capsule, "tail")) : from,
          part(round, "radius"), groups[index++]);
    }
  }

  std::vector<BodyCollider> take() { return std::move(colliders_); }

 private:
  static std::vector<std::vector<int>> groups_of_colliders(const Value& extension) {
    std::vector<std::vector<int>> of_collider(list(part(extension, "colliders")).size());
    int group = 0;
    for (const Value& stated : list(part(extension, "colliderGroups"))) {
      for (const Value& collider : list(part(stated, "colliders"))) {
        const double index = number(collider, -1, -1, 1e9);
        if (index >= 0 && index < static_cast<double>(of_collider.size()))
          if (std::vector<int>& own = of_collider[static_cast<size_t>(index)];
              own.empty() || own.back() != group)
            own.push_back(group);
      }
      ++group;
    }
    return of_collider;
  }

  void add(const Value& node, const Vector3& from, const Vector3& to, const Value& radius,
           const std::vector<int>& groups) {
    const int joint = joint_of(node_of(graph_, node));
    const double size = number(radius, 0, 0, kLargest);
    if (joint < 0 || !(size > 0))
      return source_.note(
          "a collider of spring bones",
          joint < 0 ? "is on no joint of the character's skin: left out" : "has no radius: left out");
    if (colliders_.size() < kMostColliders) colliders_.push_back({joint, from, to, size, groups});
  }

  int joint_of(int node) const {
    const auto at = std::ranges::find(joint_node_, node);
    return node < 0 || at == joint_node_.end() ? -1 : static_cast<int>(at - joint_node_.begin());
  }

  const SceneGraph& graph_;
  const std::vector<int>& joint_node_;
  Source& source_;
  std::vector<BodyCollider> colliders_;
};

}  // namespace

std::vector<BodyCollider> read_body_colliders(const tinygltf::Model& model, const SceneGraph& graph,
                                              const std::vector<int>& joint_node, Source& source) {
  ColliderReader reader(graph, joint_node, source);
  read_vrm(model, reader);
  return reader.take();
}

}  // namespace sinew::baker
