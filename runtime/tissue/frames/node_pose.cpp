// node_pose.cpp  Node frames of a pose; the arithmetic is kernels/surface/pose-inl.hpp.
#include "tissue/frames/node_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "kernels/kernels.hpp"

namespace sinew::tissue {

// As the kernel writes them.
static_assert(offsetof(NodePose, rotation) == 3 * sizeof(float));

void pose_nodes(std::span<const pack::NodeRecord> nodes, const float* skin, const float root_rotation_xyzw[4],
                NodePose* out) noexcept {
  if (nodes.empty()) return;
  const float* q = root_rotation_xyzw;
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> root =
      Eigen::Quaternionf(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
  const pack::NodeRecord& first = nodes.front();
  simd::kernels().pose_frames({.points = first.position_m,
                               .point_stride = sizeof(pack::NodeRecord),
                               .joints = first.skin.joint,
                               .weights = first.skin.weight,
                               .skin_stride = sizeof(pack::NodeRecord),
                               .matrices = skin,
                               .out = out->place_m,
                               .out_stride = sizeof(NodePose),
                               .count = static_cast<uint32_t>(nodes.size())},
                              root.data());
  for (size_t n = 0; n < nodes.size(); ++n) std::fill_n(out[n].bend, 3, 0.0f);
}

}  // namespace sinew::tissue
