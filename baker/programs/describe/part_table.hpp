// part_table.hpp  Which parts of a baked character swing, why, how fast and how far, and which stay rigid.
#pragma once
#include <string>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "pack/reader.hpp"

namespace sinew::baker {

// A line a part. Frequencies and limits of regions are the pack's.
std::string part_table(const TissueLayout& layout, const pack::PackView& pack);

}  // namespace sinew::baker
