// voxel_nodes.hpp  Soft parts that an emulator predicts stand on the corners of a coarse cage's voxels.
#pragma once
#include "baker/mesh/graph/tissue_layout.hpp"

namespace sinew::baker {

// layout_tissue's, as it is baked: regions whose recipe says "model": "deep_emulator" get the free corners of
// a cage of their own as control nodes, and the corners around them, which are held; neighbours share a
// tetrahedron. Voxels are of the size that comes nearest to Recipe::nodes_per_region free corners; a note
// tells it. Throws BadInput as layout_tissue does, and where voxels of no size leave a part a free corner, or
// all are.
TissueLayout layout_to_bake(Character& character, const Recipe& recipe);

}  // namespace sinew::baker
