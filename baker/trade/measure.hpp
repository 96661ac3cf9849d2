// measure.hpp  Every way to run a character, measured once; what was measured before is taken up again.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "baker/trade/row.hpp"
#include "baker/trade/true_surface.hpp"
#include "baker/trade/variants.hpp"

namespace sinew::baker {

// Tiers, baselines, variants, with dominated_by filled in. cache: a file that is written after each row and
// read at the start; of another character or other motions it is begun anew.
std::vector<Row> measure(const LoadedPack& character, std::span<const TrueSurface> surfaces,
                         std::span<const Variant> variants, const std::string& cache);

}  // namespace sinew::baker
