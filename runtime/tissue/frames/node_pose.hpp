// node_pose.hpp  Where control nodes are and how their flesh is turned, by linear blend skinning.
//
// How a node's flesh is turned, R_i, is the rotation of its own blended skin matrix: the columns orthonormal,
// the first kept in direction (Gram-Schmidt; where two bones meet at a hinge that is the polar rotation
// exactly). World from bind-pose axes. The frame that its tissue moves in turns a little less
// (tissue/frames/node_bend.hpp).
#pragma once
#include <cstdint>
#include <span>

#include "pack/format.hpp"

namespace sinew::tissue {

struct NodePose {
  float place_m[3];   // from the root, world axes: world-sized numbers stay out of it
  float rotation[9];  // R_i, row-major; of the node's frame once its region's bend has been shared out
  float bend[3];      // rad: R_i = rotation exp([bend]x)
};

// skin: posed x inverse bind of every joint, row-major 3x4, character space. out: one a node. A node whose
// matrix has collapsed to a plane or a line keeps whatever axes are left, completed by any others. bend is 0.
void pose_nodes(std::span<const pack::NodeRecord> nodes, const float* skin, const float root_rotation_xyzw[4],
                NodePose* out) noexcept;

}  // namespace sinew::tissue
