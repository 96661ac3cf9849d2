// look.hpp  Who is seen in this step, and how large.
//
// Seen is what some view shows and nothing is found to hide. What hides is asked about a few instances a
// step, in turn: kRaysALook rays to points of the ball about the character, others each time. It is hidden
// after kBlindLooks looks in a row without a ray that gets through, and seen again with the first that does.
// With n instances in view, each is looked at every ceil(n kRaysALook views / sight_rays_per_step) steps.
#pragma once
#include "world/world_state.hpp"

namespace sinew::world {

inline constexpr uint32_t kRaysALook = 8;

// Sets `seen` and `size` of every row. Costs some ten nanoseconds an instance and view, and the rays.
void look(WorldState& world) noexcept;

}  // namespace sinew::world
