// hold_roots.cpp  see hold_roots.hpp.
#include "baker/mesh/hold_roots.hpp"

#include <algorithm>

#include "baker/import/joint_above.hpp"
#include "baker/mesh/bone_names.hpp"
#include "baker/mesh/joint_names.hpp"

namespace sinew::baker {
namespace {

bool is_root_of_rod(const Character& character, const Recipe& recipe, size_t joint) {
  const auto is_named = [&](const RodRecipe& rod) { return is_called(character, joint, rod.root); };
  if (recipe.rods) return std::ranges::any_of(*recipe.rods, is_named);
  const auto is_root = [&](const SpringBones& spring) { return spring.root == static_cast<int>(joint); };
  if (std::ranges::any_of(character.springs, is_root)) return true;
  const NameMeaning meaning = meaning_of(joint_name(character, joint));
  return meaning.kind && swings_as_chain(*meaning.kind);
}

}  // namespace

void hold_roots(Character& character, const Recipe& recipe) {
  for (size_t j = 0; j < character.joint_node.size(); ++j) {
    if (character.joint_parent[j] >= 0 || !is_root_of_rod(character, recipe, j)) continue;
    add_joint_above(character, static_cast<int>(j));
    ++j;  // the new joint is the first: this one is the next now
  }
}

}  // namespace sinew::baker
