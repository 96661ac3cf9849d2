// scenes.hpp  The scenes of sinew-rods.
#pragma once
#include "samples/rods/story.hpp"

namespace sinew::sample {

// 1,211 segments of green wood in gusts, for this long. Throws std::runtime_error where the runtime refuses.
Story tree_in_wind(double seconds);

}  // namespace sinew::sample
