// scenes.hpp  The scenes of sinew-rods.
#pragma once
#include "samples/rods/story.hpp"

namespace sinew::sample {

// 1,211 segments of green wood in gusts, for this long. Throws std::runtime_error where the runtime refuses.
Story tree_in_wind(double seconds);
// A spring of rubber, free, onto the floor.
Story helix_on_plane(double seconds);
// A rope across another that is held at both ends.
Story two_rods(double seconds);
// A rope wound on a drum of a Bullet world, which turns and moves. Only where sinew::bullet is built.
Story drum(double seconds);

}  // namespace sinew::sample
