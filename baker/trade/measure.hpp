// measure.hpp  Every way to run a character, measured once; what was measured before is taken up again.
#pragma once
#include <span>
#include <vector>

#include "baker/trade/row_cache.hpp"
#include "baker/trade/true_surface.hpp"
#include "baker/trade/variants.hpp"

namespace sinew::baker {

// Tiers, baselines, variants, with dominated_by filled in. What the cache holds is not measured again.
std::vector<Row> measure(const LoadedPack& character, std::span<const TrueSurface> surfaces,
                         std::span<const Variant> variants, RowCache& cache);

}  // namespace sinew::baker
