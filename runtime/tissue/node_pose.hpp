// node_pose.hpp  Where control nodes are and how their flesh is turned, by linear blend skinning.
//
// A node's frame R_i is the rotation of its own blended skin matrix: the columns orthonormal, the first kept
// in direction (Gram-Schmidt; where two bones meet at a hinge that is the polar rotation exactly). World from
// bind-pose axes.
#pragma once
#include <cstdint>
#include <span>

#include "pack/format.hpp"

namespace sinew::tissue {

struct NodePose {
  float place_m[3];   // from the root, world axes: world-sized numbers stay out of it
  float rotation[9];  // R_i, row-major
};

// skin: posed x inverse bind of every joint, row-major 3x4, character space. out: one a node. A node whose
// matrix has collapsed to a plane or a line keeps whatever axes are left, completed by any others.
void pose_nodes(std::span<const pack::NodeRecord> nodes, const float* skin, const float root_rotation_xyzw[4],
                NodePose* out) noexcept;

}  // namespace sinew::tissue
