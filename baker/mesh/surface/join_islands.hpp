// join_islands.hpp  Pieces of surface that lie beside each other joined into one, as the cards of a head of
// hair are.
#pragma once
#include <limits>
#include <utility>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

using Links = std::vector<std::pair<int, int>>;

// The fewest and shortest links between vertices of one label (welded vertex -> label, -1: none) that connect
// its islands, none longer than most_gap_m. Of as short ones those of the first vertices.
Links island_links(const Character& character, const Surface& surface, const std::vector<int>& label,
                   double most_gap_m = std::numeric_limits<double>::infinity());

Surface with_links(Surface surface, const Links& links);

}  // namespace sinew::baker
