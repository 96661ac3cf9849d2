// control_nodes.hpp  The few vertices that stand for a soft part, and the graph over them.
#pragma once
#include <utility>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

// A part's vertices and its rigid surroundings, as the functions here see them.
struct PartSurface {
  const Character& character;
  const Surface& surface;
  const std::vector<int>& part;  // welded vertex -> part
  int id = 0;
  const std::vector<int>& vertices;  // of the part
  const std::vector<int>& rim;
};

// Farthest point sampling along the skin (Eldar et al. 1997), from the softest vertex. The rim counts as
// sampled: displacement is zero there, so that nodes keep clear of it. Deterministic.
std::vector<int> sample_nodes(const PartSurface& part, const std::vector<double>& stiffness, int count);

// Rim vertices spread in the same way.
std::vector<int> sample_rim(const Character& character, const std::vector<int>& rim, int count);

// Each node's nearest ones along the skin, both ways, and what else it takes to connect all. Pairs a < b of
// indices into nodes, ascending.
std::vector<std::pair<int, int>> connect_nodes(const PartSurface& part, const std::vector<int>& nodes,
                                               int neighbours);

}  // namespace sinew::baker
