// publish.cpp  The last tick's displacement brought to the render time and to the surface.
#include "world/publish.hpp"

#include "simd/kernels.hpp"
#include "tissue/node_bend.hpp"
#include "world/pose.hpp"

namespace sinew::world {
namespace {

// delta = u + (r/h)(u - u_before), along the axes of the flesh.
void carry_on(Instance& instance) noexcept {
  const float ahead = instance.state->render_fraction;
  for (size_t n = 0; n < instance.asset->node_count(); ++n) {
    float* delta = instance.delta + 3 * n;
    for (size_t k = 0; k < 3; ++k) {
      const float now = instance.shown[0][3 * n + k];
      delta[k] = now + ahead * (now - instance.shown[1][3 * n + k]);
    }
    tissue::along_flesh(instance.poses[0][n], delta, delta);
  }
}

}  // namespace

void publish(Instance& instance) noexcept {
  const pack::PackView& pack = instance.asset->pack;
  skin_matrices(pack.joints, instance.joints, instance.skin);
  instance.displaced = instance.shown_share() > 0;
  if (!instance.displaced) return;
  carry_on(instance);
  float* carried = instance.carried;
  for (const pack::RegionRecord& region : pack.regions) {
    simd::kernels().carry(pack.carry.data() + region.carry, region.node_count, region.padded_vertices,
                          instance.delta + size_t{3} * region.first_node, carried);
    carried += size_t{3} * region.padded_vertices;
  }
}

}  // namespace sinew::world
