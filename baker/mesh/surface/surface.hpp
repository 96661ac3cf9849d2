// surface.hpp  The welded surface as a graph: who touches whom, and how far it is along the skin.
#pragma once
#include <utility>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// Of a vertex that lies on another piece of surface: welded vertices of that, which lie on nothing, and their
// shares, sum 1.
using LiesOn = std::vector<std::pair<int, double>>;

struct Surface {
  // Neighbours of a welded vertex over triangle edges, ascending; empty for vertices that are welded to
  // another or in no triangle.
  std::vector<std::vector<int>> neighbours;
  std::vector<LiesOn> lies_on;  // a vertex (layers.hpp); empty: nothing lies on another piece

  bool lies(size_t vertex) const { return !lies_on.empty() && !lies_on[vertex].empty(); }
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
