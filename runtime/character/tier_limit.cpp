// tier_limit.cpp  see tier_limit.hpp.
#include "character/tier_limit.hpp"

#include "character/output/publish.hpp"
#include "character/rest/asleep.hpp"
#include "schedule/front.hpp"

namespace sinew::world {

void limit_tier(Instance& instance, Tier best) noexcept {
  InstanceState& state = *instance.state;
  if (state.tier_limit == best) return;
  state.tier_limit = best;
  wake(instance);
  state.poses.still_ticks = 0;  // dormant again only after ticks, in the first of which it gets its tier
  publish(instance);            // between ticks, what stands still is shown otherwise
}

float waited_after(const InstanceState& state, float dt_s) noexcept {
  const bool waits = !frame::is_simulated(state.tier) && state.tier_limit != Tier::kSkinning;
  return waits ? state.waited_s + dt_s : 0;
}

}  // namespace sinew::world
