// joint_names.hpp  Joints found by an artist's names.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character.hpp"

namespace sinew::baker {

const std::string& joint_name(const Character& character, size_t joint);

// For each joint, whether one of the names, or prefix*, is its. Throws BadInput for a name that no joint has,
// with the nearest one; `where` says who asks: "recipe: region 'belly'".
std::vector<bool> match_joints(const Character& character, const std::vector<std::string>& names,
                               const std::string& where);

}  // namespace sinew::baker
