// moving_part.cpp  see moving_part.hpp.
#include "baker/truth/modes/moving_part.hpp"

#include <algorithm>

namespace sinew::baker {

MovingPart moving_part(const Cage& cage, const Recipe& recipe) {
  MovingPart part;
  part.node_of_cage.assign(cage.nodes.size(), -1);
  part.material.poisson_ratio = recipe.poisson_ratio;
  part.material.density_kg_m3 = recipe.density_kg_m3;
  part.material.young_pa.clear();
  part.material.fill.clear();
  for (size_t e = 0; e < cage.tetrahedra.size(); ++e) {
    const auto& t = cage.tetrahedra[e];
    if (std::all_of(t.begin(), t.end(), [&](int n) { return cage.constrained[static_cast<size_t>(n)]; }))
      continue;
    std::array<int, 4> here{};
    for (size_t a = 0; a < 4; ++a) {
      int& node = part.node_of_cage[static_cast<size_t>(t[a])];
      if (node < 0) {
        node = static_cast<int>(part.cage_node.size());
        part.cage_node.push_back(t[a]);
        part.rest.push_back(cage.nodes[static_cast<size_t>(t[a])]);
        part.constrained.push_back(cage.constrained[static_cast<size_t>(t[a])]);
      }
      here[a] = node;
    }
    part.tetrahedra.push_back(here);
    part.cage_element.push_back(static_cast<int>(e));
    part.material.young_pa.push_back(cage.young_pa[e]);
    part.material.fill.push_back(cage.fill[e]);
  }
  return part;
}

}  // namespace sinew::baker
