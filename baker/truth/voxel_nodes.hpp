// voxel_nodes.hpp  Soft parts that an emulator predicts stand on the corners of a coarse cage's voxels.
#pragma once
#include <string>
#include <vector>

#include "baker/mesh/tissue_layout.hpp"

namespace sinew::baker {

// Regions whose recipe says "model": "deep_emulator" get the free corners of a cage of their own as control
// nodes, and the corners around them, which are held; neighbours share a tetrahedron. Voxels are of the size
// that comes nearest to Recipe::nodes_per_region free corners; notes tell it. False: no region wants it, and
// the layout is as it was. Throws BadInput where voxels of no size leave a part a free corner, or all are.
bool stand_on_voxels(const Character& character, const Recipe& recipe, TissueLayout& layout,
                     std::vector<std::string>& notes);

}  // namespace sinew::baker
