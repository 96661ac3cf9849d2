// tier_limit.hpp  The best tier that an instance may get (World::set_tier_limit).
//
//   kNetwork   all
//   kModal     what is bought is on a front without the network's points (TierCosts), so that modes are had
//              even where a network is the better buy
//   kSkinning  nothing is bought; nor does it wait for its turn
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Extrapolation is only what is left where nothing is simulated.
constexpr bool may_limit(Tier best) noexcept {
  return best == Tier::kNetwork || best == Tier::kModal || best == Tier::kSkinning;
}

// A change wakes what is dormant.
void limit_tier(Instance& instance, Tier best) noexcept;

// InstanceState::waited_s a step later, whose tier is known.
float waited_after(const InstanceState& state, float dt_s) noexcept;

}  // namespace sinew::world
