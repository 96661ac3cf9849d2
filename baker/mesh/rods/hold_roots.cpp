// hold_roots.cpp  see hold_roots.hpp.
#include "baker/mesh/rods/hold_roots.hpp"

#include <algorithm>

#include "baker/import/character/joint_above.hpp"
#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

// Joints without a parent that are roots of rods.
std::vector<int> loose_roots(const Character& character, const Recipe& recipe) {
  const JointNames names(character);
  const auto is_root = [&](size_t joint) {
    const auto is_named = [&](const RodRecipe& rod) { return names.is_called(joint, rod.root); };
    if (recipe.rods) return std::ranges::any_of(*recipe.rods, is_named);
    const auto is_spring = [&](const SpringBones& spring) { return spring.root == static_cast<int>(joint); };
    const NameMeaning meaning = meaning_of(joint_name(character, joint));
    return std::ranges::any_of(character.springs, is_spring) ||
           (meaning.kind && swings_as_chain(*meaning.kind));
  };
  std::vector<int> roots;
  for (size_t j = 0; j < character.joint_node.size(); ++j)
    if (character.joint_parent[j] < 0 && is_root(j)) roots.push_back(static_cast<int>(j));
  return roots;
}

}  // namespace

void hold_roots(Character& character, const Recipe& recipe) {
  std::vector<int> roots = loose_roots(character, recipe);
  for (size_t i = 0; i < roots.size(); ++i) {
    if (character.joint_parent[static_cast<size_t>(roots[i])] >= 0)
      continue;  // by the joint of one before it
    add_joint_above(character, roots[i]);
    for (int& root : roots) ++root;
  }
}

}  // namespace sinew::baker
