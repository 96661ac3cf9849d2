// block_modes.hpp  The soft block's modes: a few shapes in closed form instead of an eigenproblem.
#pragma once
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/truth/modes/modal_basis.hpp"

namespace sinew::scenes {

inline constexpr double kBlockSoftFrom_m = 0.25, kBlockHeight_m = 0.6;

// Six modes a region: the block above kBlockSoftFrom_m bends along x and z and stretches along y, each as a
// whole and with a node in between. 3.5 Hz for the first, 12 Hz for the last, damped by a tenth. What they
// leave out gives way by 2 mm under 10 g, at 15 Hz.
std::vector<baker::ModalBasis> block_modes(const baker::TissueLayout& layout,
                                           const baker::TissueLayout* finest = nullptr);

}  // namespace sinew::scenes
