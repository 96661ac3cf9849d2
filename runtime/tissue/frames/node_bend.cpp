// node_bend.cpp  Shares a region's bend out among its frames; the arithmetic is kernels/surface/bend-inl.hpp.
#include "tissue/frames/node_bend.hpp"

#include <algorithm>

#include "kernels/kernels.hpp"

namespace sinew::tissue {
namespace {

constexpr size_t kFloats = sizeof(NodePose) / sizeof(float);

}  // namespace

void share_bend(uint32_t anchor, uint32_t count, NodePose* nodes) noexcept {
  simd::BendJob job{
      .held = {}, .rotations = nodes->rotation, .bends = nodes->bend, .stride = kFloats, .count = count};
  std::copy_n(nodes[anchor].rotation, 9, job.held);
  simd::kernels().share_bend(job);
}

void along_flesh(const NodePose* nodes, const float* v, uint32_t count, float* out) noexcept {
  simd::kernels().turn_back(
      {.turns = nodes->bend, .turn_stride = kFloats, .in = v, .out = out, .count = count});
}

void along_frame(const NodePose* nodes, const float* v, uint32_t count, float* out) noexcept {
  simd::kernels().turn({.turns = nodes->bend, .turn_stride = kFloats, .in = v, .out = out, .count = count});
}

}  // namespace sinew::tissue
