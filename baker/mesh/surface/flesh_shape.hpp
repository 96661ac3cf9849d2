// flesh_shape.hpp  What tells flesh from sheets and from things that are fastened to one bone.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

// The joint on which the connected piece of surface of each welded vertex hangs as a whole; -1: on more than
// one, as skin does.
std::vector<int> fastened_to(const Character& character, const Surface& surface);

// The median distance through a part, straight in from its vertices to where matter ends, as a share of the
// part's extent. A surface without a back has none: 0.
double thickness_share(const Character& character, const std::vector<int>& vertices);

// Below this a part is a sheet or a shell, not flesh.
inline constexpr double kThinSheet = 0.08;

double extent_m(const Character& character, const std::vector<int>& vertices);  // the box's diagonal

}  // namespace sinew::baker
