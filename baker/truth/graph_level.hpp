// graph_level.hpp  Coarser control graphs of a character, each ready to be packed beside the finest.
#pragma once
#include <vector>

#include "baker/truth/modes/modal_basis.hpp"

namespace sinew::baker {

class TissueTruth;

struct GraphLevel {
  TissueLayout layout;
  std::vector<ModalBasis> modes;  // the finest's, at this layout's nodes
};

// As recipe.coarser_nodes lists them, finest first, but for those with no fewer nodes than the one before;
// where the recipe leaves regions out one more. `modes` are those of `finest`.
std::vector<GraphLevel> coarser_levels(const Character& character, const Recipe& recipe, TissueTruth& truth,
                                       const TissueLayout& finest, const std::vector<ModalBasis>& modes);

}  // namespace sinew::baker
