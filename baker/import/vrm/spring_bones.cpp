// spring_bones.cpp  Spring bones that a VRM file states, version 0 and 1.
#include "baker/import/vrm/spring_bones.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "baker/import/gltf/vrm_values.hpp"

namespace sinew::baker {
namespace {

using tinygltf::Value;

constexpr size_t kMostSprings = 1000;
constexpr double kLargestHit = 100;  // radius, in the file's units
constexpr double kTail = 0.07;       // of a bone of version 0 without one below it: UniVRM's, file's units

std::string text(const Value& value) { return value.IsString() ? value.Get<std::string>() : ""; }

// What the standards give a joint that says nothing.
struct Defaults {
  const char* stiffness_key;
  double stiffness, gravity_power, drag_force;
};
constexpr Defaults kVersion0{"stiffiness", 1, 0, 0.4};  // the standard's spelling; the numbers are UniVRM's
constexpr Defaults kVersion1{"stiffness", 1, 0, 0.5};

// A spring of version 1: all but the last node swing, and each has its numbers.
struct Chain {
  SpringBones spring;
  std::vector<int> nodes;
  std::vector<SpringNumbers> numbers;
};

// Version 0 has an object, told in Unity's left-handed space; version 1 a list. Straight down where nothing
// is said.
Vector3 direction_of(const Value& value) {
  const std::vector<Value> axes = list(value);
  const auto axis = [&](size_t k, const char* key, double otherwise) {
    return number(axes.size() == 3 ? axes[k] : part(value, key), otherwise, -1e6, 1e6);
  };
  const double mirror = axes.size() == 3 ? 1 : -1;
  const Vector3 direction(axis(0, "x", 0), axis(1, "y", value.IsObject() ? 0 : -1), mirror * axis(2, "z", 0));
  return direction.norm() > 0 ? direction.normalized() : Vector3(-Vector3::UnitY());
}

SpringNumbers numbers_of(const Value& value, const Defaults& defaults) {
  SpringNumbers numbers;
  numbers.stiffness = number(part(value, defaults.stiffness_key), defaults.stiffness, 0, 100);
  numbers.gravity_power = number(part(value, "gravityPower"), defaults.gravity_power, 0, 100);
  numbers.gravity_direction = direction_of(part(value, "gravityDir"));
  numbers.drag_force = number(part(value, "dragForce"), defaults.drag_force, 0, 1);
  numbers.hit_radius_m = number(part(value, "hitRadius"), 0, 0, kLargestHit);
  return numbers;
}

// From the root on, whatever order it is listed in: parents come first among nodes.
Chain chain_of(const SceneGraph& graph, const Value& stated) {
  std::vector<std::pair<int, SpringNumbers>> joints;
  for (const Value& joint : list(part(stated, "joints")))
    joints.emplace_back(node_of(graph, part(joint, "node")), numbers_of(joint, kVersion1));
  const auto node = [](const auto& joint) { return joint.first; };
  if (std::ranges::none_of(joints, [](const auto& joint) { return joint.first < 0; }))
    std::ranges::stable_sort(joints, {}, node);
  Chain chain;
  for (const auto& [index, numbers] : joints) {
    chain.nodes.push_back(index);
    chain.numbers.push_back(numbers);
  }
  return chain;
}

class SpringReader {
 public:
  SpringReader(const SceneGraph& graph, const std::vector<int>& joint_node, Source& source)
      : graph_(graph), source_(source), joint_of_node_(graph.nodes.size(), -1) {
    for (size_t j = joint_node.size(); j-- > 0;)  // the first of a node's joints
      joint_of_node_[static_cast<size_t>(joint_node[j])] = static_cast<int>(j);
  }

  // A bone swings with all that hangs on it, so that one below another root is part of that one's tree,
  // whatever order and groups they are listed in.
  void read_version_0(const Value& extension) {
    std::vector<SpringBones> groups;
    std::vector<Tree> trees;
    for (const Value& group : list(part(part(extension, "secondaryAnimation"), "boneGroups"))) {
      SpringBones spring;
      spring.numbers = numbers_of(group, kVersion0);
      spring.tail_m = kTail;
      spring.name = text(part(group, "comment"));
      spring.collider_groups = groups_of(group);
      note_center(group, spring.name);
      for (const Value& bone : list(part(group, "bones"))) trees.push_back({groups.size(), node_of(bone)});
      groups.push_back(std::move(spring));
    }
    const std::vector<int> outermost = outermost_trees(trees);
    for (size_t t = 0; t < trees.size(); ++t) {
      const int root = trees[t].root;
      const int tree = root < 0 ? static_cast<int>(t) : outermost[static_cast<size_t>(root)];
      if (tree != static_cast<int>(t)) {
        const Tree& above = trees[static_cast<size_t>(tree)];
        const SpringBones &own = groups[trees[t].group], &whole = groups[above.group];
        if (whole.numbers != own.numbers || whole.collider_groups != own.collider_groups)
          note(name_of(root), "is part of spring bone '" + name_of(above.root) +
                                  "', whose numbers and colliders are taken for it");
        continue;
      }
      SpringBones spring = groups[trees[t].group];
      spring.root = joint_of(root);
      add(spring, root < 0 ? spring.name : name_of(root));
    }
  }

  void read_version_1(const Value& extension) {
    std::vector<Chain> chains;
    for (const Value& stated : list(part(extension, "springs"))) {
      Chain chain = chain_of(graph_, stated);
      if (chain.nodes.empty()) continue;
      chain.spring.name = text(part(stated, "name"));
      if (chain.spring.name.empty()) chain.spring.name = name_of(chain.nodes.front());
      chain.spring.collider_groups = groups_of(stated);
      if (chain.nodes.size() < 2) {
        note(chain.spring.name, "has one joint, which nothing swings: left out");
        continue;
      }
      note_center(stated, chain.spring.name);
      chains.push_back(std::move(chain));
    }
    for (Chain& chain : joined(std::move(chains))) {
      chain.spring.numbers = chain.numbers.front();
      set_bones(chain.nodes, chain.spring);
      set_numbers(chain, chain.spring);
      add(chain.spring, chain.spring.name);
    }
  }

  std::vector<SpringBones> take() { return std::move(springs_); }

 private:
  struct Tree {
    size_t group;
    int root;  // node; -1: none
  };

  // For each node the tree that it is part of, the outermost; -1: none. Of one root listed twice the first
  // stays.
  std::vector<int> outermost_trees(const std::vector<Tree>& trees) const {
    std::vector<int> tree(graph_.nodes.size(), -1);
    for (size_t t = trees.size(); t-- > 0;)
      if (trees[t].root >= 0) tree[static_cast<size_t>(trees[t].root)] = static_cast<int>(t);
    for (size_t i = 0; i < tree.size(); ++i) {  // parents come first
      const int up = graph_.nodes[i].parent;
      if (up >= 0 && tree[static_cast<size_t>(up)] >= 0) tree[i] = tree[static_cast<size_t>(up)];
    }
    return tree;
  }

  std::string name_of(int node) const { return node < 0 ? "" : graph_.nodes[static_cast<size_t>(node)].name; }

  // A line each, so that none goes without its name.
  void note(const std::string& name, const std::string& what) {
    source_.note("", "spring '" + name + "' " + what);
  }

  // Ascending, each once.
  static std::vector<int> groups_of(const Value& value) {
    std::set<int> groups;
    for (const Value& group : list(part(value, "colliderGroups")))
      if (const double index = number(group, -1, -1, 1e6); index >= 0) groups.insert(static_cast<int>(index));
    return {groups.begin(), groups.end()};
  }

  void note_center(const Value& value, const std::string& name) {
    if (number(part(value, "center"), -1, -1, 1e9) >= 0)
      note(name, "states a center, which is not followed: it swings in the world");
  }

  // Chains that a file lists in pieces are one: a piece goes on where another ends, or is part of it.
  std::vector<Chain> joined(std::vector<Chain> chains) const {
    std::ranges::stable_sort(chains, {}, [](const Chain& chain) { return chain.nodes.front(); });
    std::vector<Chain> whole;
    std::vector<int> in_chain(graph_.nodes.size(), -1);
    for (Chain& chain : chains) {
      const int root = chain.nodes.front();
      const int into = root < 0 ? -1 : in_chain[static_cast<size_t>(root)];
      if (into >= 0 && absorbs(whole[static_cast<size_t>(into)], chain)) {
        for (const int node : chain.nodes) claim(node, into, in_chain);
        continue;
      }
      for (const int node : chain.nodes) claim(node, static_cast<int>(whole.size()), in_chain);
      whole.push_back(std::move(chain));
    }
    return whole;
  }

  static void claim(int node, int chain, std::vector<int>& in_chain) {
    if (node >= 0 && in_chain[static_cast<size_t>(node)] < 0) in_chain[static_cast<size_t>(node)] = chain;
  }

  // False, and nothing has changed, where the piece branches off.
  static bool absorbs(Chain& whole, const Chain& piece) {
    const auto begin = std::ranges::find(whole.nodes, piece.nodes.front());
    const auto [end, rest] = std::mismatch(begin, whole.nodes.end(), piece.nodes.begin(), piece.nodes.end());
    if (rest == piece.nodes.end()) return true;
    if (end != whole.nodes.end()) return false;
    const auto shared = rest - piece.nodes.begin();
    whole.numbers.back() = piece.numbers[static_cast<size_t>(shared - 1)];  // its end is a bone now
    whole.numbers.insert(whole.numbers.end(), piece.numbers.begin() + shared, piece.numbers.end());
    const std::vector<int> more(rest, piece.nodes.end());
    whole.nodes.insert(whole.nodes.end(), more.begin(), more.end());
    return true;
  }

  // The last joint is where the last bone ends, it has no numbers of its own.
  void set_numbers(const Chain& chain, SpringBones& spring) {
    for (size_t i = 0; i + 1 < chain.nodes.size(); ++i)
      if (const int joint = joint_of(chain.nodes[i]); joint >= 0)
        spring.of_joints.emplace_back(joint, chain.numbers[i]);
    const auto pulled_otherwise = [&](const auto& bone) {
      return bone.second.gravity_power != spring.numbers.gravity_power ||
             bone.second.gravity_direction != spring.numbers.gravity_direction;
    };
    if (std::ranges::any_of(spring.of_joints, pulled_otherwise))
      note(spring.name, "has joints that differ in gravity: the first one's is taken for all");
  }

  // Each bone ends where the next one is. What nothing that is shown hangs on moves nothing, so that the last
  // one that does ends the chain.
  void set_bones(const std::vector<int>& nodes, SpringBones& spring) {
    size_t last = nodes.size() - 2;
    while (last > 0 && joint_of(nodes[last]) < 0) --last;
    spring.root = joint_of(nodes[0]);
    spring.end = joint_of(nodes[last]);
    if (last < nodes.size() - 2 && spring.root >= 0)
      note(spring.name,
           "moves nothing that is shown with its last joints: it ends at the last one that does");
    if (hangs_on(nodes[last + 1], nodes[last])) spring.end_node = nodes[last + 1];
  }

  bool hangs_on(int node, int above) const {
    if (node == above || above < 0) return false;
    while (node >= 0 && node != above) node = graph_.nodes[static_cast<size_t>(node)].parent;
    return node >= 0;
  }

  int node_of(const Value& stated) const { return baker::node_of(graph_, stated); }

  int joint_of(int node) const { return node < 0 ? -1 : joint_of_node_[static_cast<size_t>(node)]; }

  void add(const SpringBones& spring, const std::string& name) {
    if (springs_.size() >= kMostSprings)
      return source_.note("", "more than 1000 spring bones: the rest is left out");
    if (spring.root < 0) return note(name, "moves no bone that anything shown hangs on: left out");
    springs_.push_back(spring);
  }

  const SceneGraph& graph_;
  Source& source_;
  std::vector<int> joint_of_node_;
  std::vector<SpringBones> springs_;
};

// The nodes alone, before there are joints.
class NodeReader {
 public:
  explicit NodeReader(const SceneGraph& graph) : graph_(graph), swings_(graph.nodes.size(), false) {}

  void read_version_0(const Value& extension) {
    for (const Value& group : list(part(part(extension, "secondaryAnimation"), "boneGroups")))
      for (const Value& bone : list(part(group, "bones"))) mark(node_of(graph_, bone));
    for (size_t i = 0; i < swings_.size(); ++i) {  // parents come first
      const int up = graph_.nodes[i].parent;
      if (up >= 0 && swings_[static_cast<size_t>(up)]) swings_[i] = true;
    }
  }

  void read_version_1(const Value& extension) {
    for (const Value& stated : list(part(extension, "springs"))) {
      const std::vector<int> nodes = chain_of(graph_, stated).nodes;
      for (size_t i = 0; i + 1 < nodes.size(); ++i) mark(nodes[i]);
    }
  }

  std::vector<bool> take() { return std::move(swings_); }

 private:
  void mark(int node) {
    if (node >= 0) swings_[static_cast<size_t>(node)] = true;
  }

  const SceneGraph& graph_;
  std::vector<bool> swings_;
};

}  // namespace

std::vector<bool> spring_nodes(const tinygltf::Model& model, const SceneGraph& graph) {
  NodeReader reader(graph);
  read_vrm(model, reader);
  return reader.take();
}

std::vector<SpringBones> read_spring_bones(const tinygltf::Model& model, const SceneGraph& graph,
                                           const std::vector<int>& joint_node, Source& source) {
  SpringReader reader(graph, joint_node, source);
  read_vrm(model, reader);
  return reader.take();
}

}  // namespace sinew::baker
