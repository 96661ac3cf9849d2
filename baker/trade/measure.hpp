// measure.hpp  Every way to run a character, measured once; what was measured before is taken up again.
#pragma once
#include <span>
#include <vector>

#include "baker/measure/true_surface.hpp"
#include "baker/trade/rows/row_cache.hpp"
#include "baker/trade/source/variants.hpp"

namespace sinew::baker {

struct Measurement {
  std::vector<Row> rows;       // tiers, baselines, variants, with dominated_by filled in
  size_t measured_before = 0;  // of these: the cache held them
};

Measurement measure(const LoadedPack& character, std::span<const TrueSurface> surfaces,
                    std::span<const Variant> variants, RowCache& cache);

}  // namespace sinew::baker
