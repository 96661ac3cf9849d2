// joint_names.hpp  Joints found by an artist's names.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character.hpp"

namespace sinew::baker {

const std::string& joint_name(const Character& character, size_t joint);

// The names of its node and those above, "root/hips/tail_1"; #1, #2 tells like siblings apart: "head/ear#2".
std::string joint_path(const Character& character, size_t joint);
// Its name, and where another bone has that, too, as much of the end of its path as no other one has.
std::string unique_joint_name(const Character& character, size_t joint);

// Whether the name, end of a path, or prefix* is the joint's.
bool is_called(const Character& character, size_t joint, const std::string& name);

// For each joint, whether one of the names, ends of paths, or prefix*, is its. Throws BadInput for a name
// that no joint has, with the nearest one; `where` says who asks: "recipe: region 'belly'".
std::vector<bool> match_joints(const Character& character, const std::vector<std::string>& names,
                               const std::string& where);

// The one bone of that name. Throws BadInput for none, and for several with their paths.
size_t find_joint(const Character& character, const std::string& name, const std::string& where);

}  // namespace sinew::baker
