// publish.cpp  The last tick's displacement brought to the render time and to the surface.
#include "world/publish.hpp"

#include "simd/kernels.hpp"
#include "tissue/drive.hpp"
#include "world/pose.hpp"

namespace sinew::world {
namespace {

void rotate(const double rotation[9], const float u[3], float out[3]) noexcept {
  for (int k = 0; k < 3; ++k) {
    out[k] = static_cast<float>(rotation[3 * k]) * u[0] + static_cast<float>(rotation[3 * k + 1]) * u[1] +
             static_cast<float>(rotation[3 * k + 2]) * u[2];
  }
}

// delta = R (u + (r/h)(u - u_before)) in character axes.
void turn_displacement(Instance& instance, const pack::RegionRecord& region) noexcept {
  const RootTransform character_space;
  const tissue::RegionFrame frame =
      tissue::region_frame(instance.skin + size_t{12} * region.frame_joint, region.center_m,
                           character_space.position_m, character_space.rotation_xyzw);
  const float ahead = instance.state->render_fraction;
  for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
    const float* now = instance.shown[0] + size_t{3} * n;
    const float* before = instance.shown[1] + size_t{3} * n;
    float u[3];
    for (int k = 0; k < 3; ++k) u[k] = now[k] + ahead * (now[k] - before[k]);
    rotate(frame.rotation, u, instance.delta + size_t{3} * n);
  }
}

}  // namespace

void publish(Instance& instance) noexcept {
  const pack::PackView& pack = instance.asset->pack;
  skin_matrices(pack.joints, instance.joints, instance.skin);
  instance.displaced = instance.shown_share() > 0;
  if (!instance.displaced) return;
  float* carried = instance.carried;
  for (const pack::RegionRecord& region : pack.regions) {
    turn_displacement(instance, region);
    simd::kernels().carry(pack.carry.data() + region.carry, region.node_count, region.padded_vertices,
                          instance.delta + size_t{3} * region.first_node, carried);
    carried += size_t{3} * region.padded_vertices;
  }
}

}  // namespace sinew::world
