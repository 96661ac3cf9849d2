// simulated_shown.cpp  see simulated_shown.hpp.
#include "character/transition/simulated_shown.hpp"

#include "character/parameters/tuned_parts.hpp"
#include "character/transition/shares.hpp"
#include "tissue/frames/node_bend.hpp"

namespace sinew::world {

void keep_regained_share(const Instance& instance, float* shown, float x) noexcept {
  if (instance.state->transition.seam_ticks >= kBlendInTicks) return;
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    if (!instance.transition.regained[r]) continue;
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    const float share = regained_share(instance, r, x);
    float* at = shown + size_t{3} * region.first_node;
    for (size_t i = 0; i < size_t{3} * region.node_count; ++i) at[i] *= share;
  }
}

void take_simulated(const Instance& instance, int tick, float* out) noexcept {
  tissue::along_flesh(instance.motion.poses[0], instance.tissue.u[tick], instance.level->node_count(), out);
  keep_regained_share(instance, out);
  keep_intensity(instance, out);
}

}  // namespace sinew::world
