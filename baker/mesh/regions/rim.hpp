// rim.hpp  How wide a region's softness fades to the rigid skin around it.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

// Softness of welded vertices, 0 rigid .. 1, that nowhere changes by more than 1 over width_m along the
// skin. It spreads outwards over skin of which `open` is above 0, up to `open` itself, and where that ends it
// is lowered inwards.
void fade_rim(const Character& character, const Surface& surface, const std::vector<double>& open,
              double width_m, std::vector<double>& softness);

// Wide enough for what is to move by wanted_share of its radius: the skin stretches by a quarter where the
// fade is even, and by half where it is twice as steep. Never less than three edges of the skin.
double rim_width_m(const Character& character, const Surface& surface, const std::vector<double>& softness,
                   double wanted_share);

}  // namespace sinew::baker
