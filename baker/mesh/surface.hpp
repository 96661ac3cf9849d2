// surface.hpp  The welded surface as a graph: who touches whom, and how far it is along the skin.
#pragma once
#include <vector>

#include "baker/import/character.hpp"

namespace sinew::baker {

struct Surface {
  // Neighbours of a welded vertex over triangle edges, ascending; empty for vertices that are welded to
  // another or in no triangle.
  std::vector<std::vector<int>> neighbours;
};

Surface find_surface(const Character& character);

// Shortest way over edges from any of `sources` to every vertex of the part (part[v] == id); infinity outside
// and where none leads.
std::vector<double> distances_along(const Character& character, const Surface& surface,
                                    const std::vector<int>& part, int id, const std::vector<int>& sources);

// Connected parts over edges between vertices for which `soft` holds: vertex -> part, -1 elsewhere. Parts are
// numbered by first vertex.
std::vector<int> connected_parts(const Surface& surface, const std::vector<bool>& soft);

}  // namespace sinew::baker
