// joint_names.cpp  Names and prefixes; the nearest name by edit distance.
#include "baker/mesh/anatomy/joint_names.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "baker/common/bad_input.hpp"
#include "baker/common/edit_distance.hpp"

namespace sinew::baker {
namespace {

std::string nearest_name(const Character& character, const std::string& name) {
  size_t best = 0, smallest = static_cast<size_t>(-1);
  for (size_t j = 0; j < character.joint_node.size(); ++j) {
    const size_t distance = edit_distance(name, joint_name(character, j));
    if (distance < smallest) smallest = distance, best = j;
  }
  return joint_name(character, best);
}

constexpr size_t kMostParts =
    32;  // of a path: a skeleton is less deep, and a hostile file's names stay short

// Of each node its name, numbered where siblings have the same.
std::vector<std::string> numbered_names(const Character& character) {
  std::map<std::pair<int, std::string>, std::vector<size_t>> alike;
  for (size_t n = 0; n < character.nodes.size(); ++n)
    alike[{character.nodes[n].parent, character.nodes[n].name}].push_back(n);
  std::vector<std::string> names(character.nodes.size());
  for (const auto& [key, nodes] : alike)
    for (size_t k = 0; k < nodes.size(); ++k)
      names[nodes[k]] = nodes.size() > 1 ? key.second + "#" + std::to_string(k + 1) : key.second;
  return names;
}

bool ends_path(const std::string& path, const std::string& end) {
  return path == end ||
         (path.size() > end.size() && path.ends_with(end) && path[path.size() - end.size() - 1] == '/');
}

bool may_be_path(const std::string& name) { return name.find_first_of("/#") != std::string::npos; }

}  // namespace

const std::string& joint_name(const Character& character, size_t joint) {
  return character.nodes[static_cast<size_t>(character.joint_node[joint])].name;
}

JointNames::JointNames(const Character& character) : character_(character) {
  const std::vector<std::string> numbered = numbered_names(character);
  for (size_t j = 0; j < character.joint_node.size(); ++j) {
    std::string path, plain;
    size_t parts = 0;
    int node = character.joint_node[j];
    for (; node >= 0 && parts < kMostParts;
         node = character.nodes[static_cast<size_t>(node)].parent, ++parts) {
      const char* slash = parts > 0 ? "/" : "";
      path = numbered[static_cast<size_t>(node)] + slash + path;
      plain = character.nodes[static_cast<size_t>(node)].name + slash + plain;
    }
    if (node < 0) path = "/" + path, plain = "/" + plain;  // from a root on
    paths_.push_back(std::move(path));
    plain_.push_back(std::move(plain));
    called_[joint_name(character, j)].push_back(j);
  }
}

bool JointNames::is_called(size_t joint, const std::string& name) const {
  const std::string& own = joint_name(character_, joint);
  if (name.ends_with('*')) return own.starts_with(name.substr(0, name.size() - 1));
  return own == name ||
         (may_be_path(name) && (ends_path(paths_[joint], name) || ends_path(plain_[joint], name)));
}

std::string JointNames::unique(size_t joint) const {
  const std::string& name = joint_name(character_, joint);
  const auto is_other = [&](size_t j) { return character_.joint_node[j] != character_.joint_node[joint]; };
  const std::vector<size_t>& namesakes = called_.at(name);
  if (std::ranges::none_of(namesakes, is_other)) return name;
  const std::string& path = paths_[joint];
  const auto shared = [&](const std::string& end) {
    return std::ranges::any_of(namesakes, [&](size_t j) { return is_other(j) && is_called(j, end); });
  };
  for (size_t slash = path.rfind('/'); slash != std::string::npos && slash > 0;
       slash = path.rfind('/', slash - 1))
    if (!shared(path.substr(slash + 1))) return path.substr(slash + 1);
  const bool whole = path.starts_with('/') && shared(path.substr(1));
  return path.starts_with('/') && !whole ? path.substr(1) : path;
}

std::vector<bool> match_joints(const Character& character, const std::vector<std::string>& names,
                               const std::string& where) {
  std::vector<bool> matched(character.joint_node.size(), false);
  if (names.empty()) return matched;
  const JointNames of_joints(character);
  for (const std::string& name : names) {
    bool found = false;
    for (size_t j = 0; j < matched.size(); ++j)
      if (of_joints.is_called(j, name)) matched[j] = found = true;
    if (!found)
      throw BadInput(character.name + ": " + where + ": no joint is named '" + name + "'; the nearest is '" +
                     nearest_name(character, name) + "'");
  }
  return matched;
}

size_t find_joint(const Character& character, const std::string& name, const std::string& where) {
  const std::vector<bool> matched = match_joints(character, {name}, where);
  const auto first = static_cast<size_t>(std::ranges::find(matched, true) - matched.begin());
  for (size_t j = first + 1; j < matched.size(); ++j) {
    if (!matched[j] || character.joint_node[j] == character.joint_node[first]) continue;
    const JointNames names(character);
    throw BadInput(character.name + ": " + where + ": '" + name + "' is the name of two bones; say '" +
                   names.unique(first) + "' or '" + names.unique(j) + "' ('" + names.path(first) + "', '" +
                   names.path(j) + "')");
  }
  return first;
}

}  // namespace sinew::baker
