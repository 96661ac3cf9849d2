// graph_level.hpp  Coarser control graphs of a character, each ready to be packed beside the finest.
#pragma once
#include <vector>

#include "baker/truth/modal_basis.hpp"

namespace sinew::baker {

class TissueTruth;

struct GraphLevel {
  TissueLayout layout;
  std::vector<ModalBasis> modes;  // the finest's, at this layout's nodes
};

// As many as recipe.coarser_nodes lists, finest of them first, and where it leaves regions out one more.
// `modes` are those of `finest`.
std::vector<GraphLevel> coarser_levels(const Character& character, const Recipe& recipe, TissueTruth& truth,
                                       const TissueLayout& finest, const std::vector<ModalBasis>& modes);

}  // namespace sinew::baker
