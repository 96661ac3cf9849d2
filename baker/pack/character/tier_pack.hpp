// tier_pack.hpp  What a character's tiers cost and how far they are from the truth, as baked.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pack/format.hpp"

namespace sinew::baker {

// What is baked must be the same on every machine, so costs are not timed here: multiply-adds at this rate on
// one core. The runtime corrects them; sinew-trade puts measured ones in their place.
inline constexpr double kBakedCostFlops = 60e9;

// Of one network step; graph_entries: non-zeros of the aggregation matrix. Padding that the kernels compute
// counts.
uint64_t multiply_adds(std::span<const pack::LayerRecord> layers, size_t nodes, size_t graph_entries);

// In every simulated tier.
struct RodWork {
  size_t segments = 0;
  uint64_t network_multiply_adds = 0;  // of learned starts, a strand by itself
};

struct TierWork {
  size_t nodes = 0;
  uint64_t mode_floats = 0;            // of the modal bases' matrices
  uint64_t network_multiply_adds = 0;  // 0: no network
  RodWork rods = {};
};

// Every tier that the work allows at every level of control graphs, `work`'s finest first, simulated every
// tick; errors are not measured, NaN, but skinning's ratio, which is 1 by definition.
std::vector<pack::TierRecord> make_tiers(std::span<const TierWork> work);

}  // namespace sinew::baker
