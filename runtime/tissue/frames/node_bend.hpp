// node_bend.hpp  Node frames that follow three quarters of their region's bend.
//
// With R_i a node's flesh and R_a that of the node where its region is held (RegionRecord::anchor_node), the
// bend is beta_i = log(R_a^T R_i) and the node's frame F_i = R_a exp(3/4 beta_i). The modes are those of the
// bind pose. In the frames of the flesh itself a bent tail's tip swings along its own axes alone; in those of
// its root, as if it were straight. A turn near the root moves the tip about the root, not about itself, so
// the truth lies between; this share validated best. Beyond a bend of 2.3 rad it returns to the flesh's own
// frame, since at pi the shorter way round changes sides.
#pragma once
#include <cstdint>

#include "tissue/frames/node_pose.hpp"

namespace sinew::tissue {

// Nodes of one region, as pose_nodes left them; anchor < count. rotation becomes F_i, and bend, what the
// flesh is turned beyond it, beta_i / 4; 0 where a frame is not a number.
void share_bend(uint32_t anchor, uint32_t count, NodePose* nodes) noexcept;

// Vectors along nodes' frames, along the axes of their flesh: exp([bend]x)^T v; and back. v, out [count][3];
// v may be out.
void along_flesh(const NodePose* nodes, const float* v, uint32_t count, float* out) noexcept;
void along_frame(const NodePose* nodes, const float* v, uint32_t count, float* out) noexcept;

}  // namespace sinew::tissue
