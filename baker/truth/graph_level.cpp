// graph_level.cpp  see graph_level.hpp.
#include "baker/truth/graph_level.hpp"

#include "baker/mesh/graph/leave_out.hpp"
#include "baker/truth/tissue_truth.hpp"

namespace sinew::baker {
namespace {

int held_vertex(const TissueLayout& layout, const std::vector<ModalBasis>& modes, size_t region) {
  const int node = layout.regions[region].first_node + modes[region].anchor_node;
  return layout.nodes[static_cast<size_t>(node)].vertex;
}

int node_on(const TissueLayout& layout, const Region& region, int vertex) {
  int n = 0;
  while (layout.nodes[static_cast<size_t>(region.first_node + n)].vertex != vertex) ++n;
  return n;
}

ModalBasis without_nodes(ModalBasis basis) {
  basis.shape.resize(0, basis.shape.cols());
  basis.turn.resize(0, basis.turn.cols());
  basis.force.resize(basis.force.rows(), 0);
  basis.rest.resize(0, 0);
  basis.anchor_node = 0;
  return basis;
}

GraphLevel with_regions_left_out(GraphLevel level, const Character& character, const Recipe& recipe) {
  level.layout = leave_out(level.layout, recipe.left_out, character.name + ": recipe: left_out");
  for (size_t r = 0; r < level.modes.size(); ++r)
    if (level.layout.regions[r].node_count == 0) level.modes[r] = without_nodes(level.modes[r]);
  return level;
}

}  // namespace

std::vector<GraphLevel> coarser_levels(const Character& character, const Recipe& recipe, TissueTruth& truth,
                                       const TissueLayout& finest, const std::vector<ModalBasis>& modes) {
  std::vector<int> held;
  for (size_t r = 0; r < finest.regions.size(); ++r) held.push_back(held_vertex(finest, modes, r));
  std::vector<GraphLevel> levels;
  size_t fewest = finest.nodes.size();
  for (const int nodes : recipe.coarser_nodes) {
    GraphLevel level{coarser_layout(character, recipe, finest, held, nodes), {}};
    if (level.layout.nodes.size() >= fewest) continue;
    fewest = level.layout.nodes.size();
    level.modes = truth.modal_bases(level.layout, kMostModes, &finest);
    for (size_t r = 0; r < held.size(); ++r)
      level.modes[r].anchor_node = node_on(level.layout, level.layout.regions[r], held[r]);
    levels.push_back(std::move(level));
  }
  if (!recipe.left_out.empty()) {
    const GraphLevel last = levels.empty() ? GraphLevel{finest, modes} : levels.back();
    levels.push_back(with_regions_left_out(last, character, recipe));
  }
  return levels;
}

}  // namespace sinew::baker
