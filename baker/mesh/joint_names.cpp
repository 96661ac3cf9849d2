// joint_names.cpp  Names and prefixes; the nearest name by edit distance.
#include "baker/mesh/joint_names.hpp"

#include <algorithm>

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

bool matches(const std::string& joint, const std::string& name) {
  if (name.ends_with('*')) return joint.starts_with(name.substr(0, name.size() - 1));
  return joint == name;
}

}  // namespace

const std::string& joint_name(const Character& character, size_t joint) {
  return character.nodes[static_cast<size_t>(character.joint_node[joint])].name;
}

std::vector<bool> match_joints(const Character& character, const std::vector<std::string>& names,
                               const std::string& where) {
  std::vector<bool> matched(character.joint_node.size(), false);
  for (const std::string& name : names) {
    bool found = false;
    for (size_t j = 0; j < matched.size(); ++j)
      if (matches(joint_name(character, j), name)) matched[j] = found = true;
    if (!found)
      throw BadInput(character.name + ": " + where + ": no joint is named '" + name + "'; the nearest is '" +
                     nearest_name(character, name) + "'");
  }
  return matched;
}

}  // namespace sinew::baker
