// joint_names.cpp  Names and prefixes; the nearest name by edit distance.
#include "baker/mesh/joint_names.hpp"

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

// Of each node its name, numbered where siblings have the same.
std::vector<std::string> path_parts(const Character& character) {
  std::map<std::pair<int, std::string>, std::vector<size_t>> alike;
  for (size_t n = 0; n < character.nodes.size(); ++n)
    alike[{character.nodes[n].parent, character.nodes[n].name}].push_back(n);
  std::vector<std::string> parts(character.nodes.size());
  for (const auto& [key, nodes] : alike)
    for (size_t k = 0; k < nodes.size(); ++k)
      parts[nodes[k]] = nodes.size() > 1 ? key.second + "#" + std::to_string(k + 1) : key.second;
  return parts;
}

std::vector<std::string> plain_names(const Character& character) {
  std::vector<std::string> names;
  for (const Node& node : character.nodes) names.push_back(node.name);
  return names;
}

std::string path_of(const Character& character, const std::vector<std::string>& parts, size_t joint) {
  std::string path;
  for (int node = character.joint_node[joint]; node >= 0;
       node = character.nodes[static_cast<size_t>(node)].parent)
    path = parts[static_cast<size_t>(node)] + (path.empty() ? "" : "/" + path);
  return path;
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

std::string joint_path(const Character& character, size_t joint) {
  return path_of(character, path_parts(character), joint);
}

bool is_called(const Character& character, size_t joint, const std::string& name) {
  const std::string& own = joint_name(character, joint);
  if (name.ends_with('*')) return own.starts_with(name.substr(0, name.size() - 1));
  if (own == name) return true;
  return may_be_path(name) && (ends_path(joint_path(character, joint), name) ||
                               ends_path(path_of(character, plain_names(character), joint), name));
}

std::string unique_joint_name(const Character& character, size_t joint) {
  const std::string& name = joint_name(character, joint);
  std::vector<size_t> namesakes;
  for (size_t j = 0; j < character.joint_node.size(); ++j)
    if (joint_name(character, j) == name && character.joint_node[j] != character.joint_node[joint])
      namesakes.push_back(j);
  if (namesakes.empty()) return name;
  const std::vector<std::string> parts = path_parts(character);
  const std::string path = path_of(character, parts, joint);
  std::vector<std::string> others;
  for (const size_t j : namesakes) others.push_back(path_of(character, parts, j));
  const auto shared = [&](const std::string& end) {
    return std::ranges::any_of(others, [&](const std::string& other) { return ends_path(other, end); });
  };
  for (size_t slash = path.rfind('/'); slash != std::string::npos && slash > 0;
       slash = path.rfind('/', slash - 1))
    if (!shared(path.substr(slash + 1)) && path.substr(slash + 1) != name) return path.substr(slash + 1);
  return path;
}

size_t find_joint(const Character& character, const std::string& name, const std::string& where) {
  const std::vector<bool> matched = match_joints(character, {name}, where);
  const auto first = static_cast<size_t>(std::ranges::find(matched, true) - matched.begin());
  for (size_t j = first + 1; j < matched.size(); ++j)
    if (matched[j] && character.joint_node[j] != character.joint_node[first])
      throw BadInput(character.name + ": " + where + ": '" + name + "' is the name of two bones; say '" +
                     unique_joint_name(character, first) + "' or '" + unique_joint_name(character, j) +
                     "' ('" + joint_path(character, first) + "', '" + joint_path(character, j) + "')");
  return first;
}

std::vector<bool> match_joints(const Character& character, const std::vector<std::string>& names,
                               const std::string& where) {
  std::vector<bool> matched(character.joint_node.size(), false);
  for (const std::string& name : names) {
    bool found = false;
    for (size_t j = 0; j < matched.size(); ++j)
      if (is_called(character, j, name)) matched[j] = found = true;
    if (!found)
      throw BadInput(character.name + ": " + where + ": no joint is named '" + name + "'; the nearest is '" +
                     nearest_name(character, name) + "'");
  }
  return matched;
}

}  // namespace sinew::baker
