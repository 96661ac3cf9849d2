// guard.hpp  What stands between the tissue's numbers and the character, after a step.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "pack/format.hpp"
#include "tissue/network.hpp"

namespace sinew::tissue {

bool all_finite(const float* values, size_t count) noexcept;

// NaN in any state reaches y of the last layer in the step it arises in, so y is what is looked at; with an
// unbounded cell state (state_clamp infinite) every c is looked at as well.
bool network_is_finite(const Network& network, uint32_t node_count, const float* state) noexcept;

// A network's memory of nodes; none: nothing but l is held.
struct NodeMemory {
  const Network* network = nullptr;
  uint32_t node_count = 0;  // of the whole character
  float* state = nullptr;
};

// l beyond its region's limit is brought back along its own direction, and l_before with it, so that it has
// no velocity: a clamp alone would leave the states behind it pushing. The node's states in every layer
// become zero and its y what l is; its neighbours forget what they gathered from it at the rate of
// hidden_leak. l, l_before: [region nodes][3], metres. Returns the nodes held.
uint32_t hold_at_limit(const pack::RegionRecord& region, const NodeMemory& memory, float* l,
                       float* l_before) noexcept;

struct TwoTicks {
  float *now, *before;
};

// A modal base that brings a node beyond the region's limit is scaled as a whole, l, q and r alike, and
// stops: what was before becomes what is now. Holding single nodes and projecting would push stiff modes with
// what was cut off. l, r: [region nodes][3], metres; q: [modes]. Returns the nodes that were beyond.
uint32_t hold_base_at_limit(const pack::RegionRecord& region, uint32_t modes, float* l, const TwoTicks& q,
                            const TwoTicks& r) noexcept;

// l ([node_count][3], metres) of y and back.
void read_output(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                 const float* state, float* l) noexcept;
void write_output(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                  const float* l, float* state) noexcept;

// The state of a network that stands at l with no memory: y of the last layer is that, everything else zero.
void rebase_state(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                  const float* l, float* state) noexcept;

}  // namespace sinew::tissue
