// joint_above.hpp  A joint for what holds a chain of bones that has no joint above it.
#pragma once
#include "baker/import/character/character.hpp"

namespace sinew::baker {

// Makes a joint of the node above that of `joint`, which has no parent; where there is no node above, of a
// new one called "root", which stays where the instance's root is. Joints below it become its children. All
// that names joints or nodes is renumbered; the new joint comes first.
void add_joint_above(Character& character, int joint);

}  // namespace sinew::baker
