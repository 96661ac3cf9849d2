// node_bend.cpp  Shares a region's bend out among its frames; the arithmetic is simd/bend-inl.hpp.
#include "tissue/node_bend.hpp"

#include <algorithm>

#include "simd/kernels.hpp"
#include "tissue/modal_base.hpp"

namespace sinew::tissue {

void share_bend(uint32_t anchor, uint32_t count, NodePose* nodes) noexcept {
  constexpr size_t kFloats = sizeof(NodePose) / sizeof(float);
  simd::BendJob job{
      .held = {}, .rotations = nodes->rotation, .bends = nodes->bend, .stride = kFloats, .count = count};
  std::copy_n(nodes[anchor].rotation, 9, job.held);
  simd::kernels().share_bend(job);
}

void along_flesh(const NodePose& node, const float v[3], float out[3]) noexcept {
  turn_back(node.bend, v, out);
}

void along_frame(const NodePose& node, const float v[3], float out[3]) noexcept {
  const float back[3] = {-node.bend[0], -node.bend[1], -node.bend[2]};
  turn_back(back, v, out);
}

}  // namespace sinew::tissue
