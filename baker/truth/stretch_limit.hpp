// stretch_limit.hpp  How far a region may move before its surface looks torn.
#pragma once
#include "baker/truth/modal_basis.hpp"

namespace sinew::baker {

// Under a steady load along each axis no edge of the surface is to be longer than this times its length.
inline constexpr double kMostStretch = 1.45;  // the audit allows 1.5 beyond skinning's

// Lowers max_displacement of regions whose recipe states none, where they would stretch an edge further at
// their limit: flesh with a narrow rim may move less.
void limit_by_stretch(const Character& character, const std::vector<ModalBasis>& bases, TissueLayout& layout);

}  // namespace sinew::baker
