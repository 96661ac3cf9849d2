// publish.cpp  The last tick's displacement brought to the render time and to the surface.
#include "world/publish.hpp"

#include "simd/kernels.hpp"
#include "world/pose.hpp"

namespace sinew::world {
namespace {

// delta = u + (r/h)(u - u_before).
void carry_on(Instance& instance) noexcept {
  const float ahead = instance.state->render_fraction;
  const size_t floats = size_t{3} * instance.asset->node_count();
  for (size_t i = 0; i < floats; ++i) {
    const float now = instance.shown[0][i];
    instance.delta[i] = now + ahead * (now - instance.shown[1][i]);
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
