// guard.hpp  What stands between a network's output and the character, after a step.
#pragma once
#include <cstdint>
#include <span>

#include "pack/format.hpp"
#include "tissue/network.hpp"

namespace sinew::tissue {

struct GuardResult {
  uint32_t displacement_clamps = 0;  // nodes held at their region's limit in this step
  bool restart = false;              // NaN or infinity: `displacement` is not written, the state is worthless
};

// displacement ([node_count][3], metres, region axes) = y of the last layer x length unit. A node beyond its
// region's limit is brought back to it along its own direction, in y too, and its other states in every layer
// are set to zero: a clamp alone would leave the states behind it pushing. NaN in any state reaches y in the
// step it arises in, so y is what is looked at; with an unbounded cell state (state_clamp infinite) every c
// is looked at as well.
GuardResult guard_step(const Network& network, std::span<const pack::RegionRecord> regions,
                       uint32_t node_count, float* state, float* displacement) noexcept;

// The state of a network that stands at `displacement` ([node_count][3], metres) with no memory: y of the
// last layer is that, everything else zero. For a start, a resume after extrapolation, or a restart.
void rebase_state(const Network& network, uint32_t node_count, const float* displacement,
                  float* state) noexcept;

}  // namespace sinew::tissue
