// region_frequency.hpp  Scales the moduli of each region so that its first mode has the frequency it is to
// have.
#pragma once
#include "baker/truth/cage/cage.hpp"

namespace sinew::baker {

// Within a hundredth, of regions whose Region::frequency_hz is not 0, other regions held. Throws BadInput for
// a region that a recipe states and of which no node of the cage is free.
Cage with_frequencies(Cage cage, const TissueLayout& layout, const Recipe& recipe);

}  // namespace sinew::baker
