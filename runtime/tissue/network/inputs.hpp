// inputs.hpp  What the nodes of a region are fed, in the order and units that the pack's input list states.
#pragma once
#include <cstddef>
#include <cstdint>

#include "pack/format.hpp"
#include "tissue/network/network_weights.hpp"

namespace sinew::tissue {

// Floats in a row of z: input_width rounded up to 16.
size_t input_stride(const Network& network) noexcept;

struct NodeSources {  // of one region; every array starts at the region's first node
  const pack::RegionRecord* region;
  const pack::NodeRecord* nodes;
  const float* drive;     // [nodes][kNodeDriveWidth], tissue/frames/node_drive.hpp
  const float* felt;      // [nodes][3], m/s^2: e, tissue/modes/modal_base.hpp
  const float* l;         // [nodes][3], metres, of the last tick
  const float* l_before;  // [nodes][3], metres, of the tick before
  const float* l_hat;     // [nodes][3], metres: what the modal base says of this tick
  const float* theta;     // [nodes][3], rad, of the last tick
  float first_rad_per_s;  // w1
  float tick_s;
};

// Metres of a length unit in the region.
float length_unit_m(const Network& network, const pack::RegionRecord& region) noexcept;

// Fills z, [region nodes][input_stride], 64-byte aligned, padding zero. Returns how many numbers lay outside
// their envelope and were clamped to it; what is not finite counts too and becomes 0. network.inputs must not
// be empty.
uint32_t assemble_inputs(const Network& network, const NodeSources& sources, float* z) noexcept;

// How much a network is believed that was fed so many clamped numbers: 1 inside its envelope, 0 once a
// twentieth of a region's numbers lie outside, or where its tissue swings a quarter faster than any that the
// network was trained on.
float trust_in(const Network& network, const NodeSources& sources, uint32_t clamped) noexcept;

}  // namespace sinew::tissue
