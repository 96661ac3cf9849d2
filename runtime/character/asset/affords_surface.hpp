// affords_surface.hpp  Which tiers afford the skins that rods may touch (ContactDef::surface).
//
// What is simulated on the finest control graph. On others the capsules about an instance's own bones stand
// in their place. Both are part of the state: what rods touch has the scheduler's hysteresis and a
// snapshot's bits.
#pragma once
#include <cstdint>

#include "schedule/front.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

constexpr bool affords_surface(Tier tier, uint32_t level) noexcept {
  return level == 0 && frame::is_simulated(tier);
}

}  // namespace sinew::world
