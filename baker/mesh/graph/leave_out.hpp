// leave_out.hpp  A control graph without some of its regions.
#pragma once
#include <string>
#include <vector>

#include "baker/mesh/graph/tissue_layout.hpp"

namespace sinew::baker {

// Those regions keep their vertices and lose their nodes. names: of regions, or prefix*. Throws BadInput: a
// name that no region has, or nothing that is left; `where` says who asks.
TissueLayout leave_out(const TissueLayout& layout, const std::vector<std::string>& names,
                       const std::string& where);

}  // namespace sinew::baker
