// network.hpp  Alt-ConvLSTM on a graph: views of baked weights, state, one step.
//
// Equations: pack/format.hpp, NetworkRecord.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "tissue/network/layer_state.hpp"
#include "tissue/network/network_weights.hpp"

namespace sinew::tissue {

// Scratch is not state: nothing in it survives a step.
size_t scratch_floats(const Network& network, uint32_t node_count) noexcept;

// One step. z: [node_count][input_width rounded up to 16], padding zero. carry: [node_count][3] added to the
// last layer's y, or null. After it the last layer's y (first 3 of each row of `padded`) is the output. The
// same bits on every target with FMA; the sums run over k in order, whatever the vector width. A NaN in a
// state, or an infinity outside a clamped cell, reaches the output in the same step.
void network_step(const Network& network, const Graph& graph, const float* z, const float* carry,
                  float* state, float* scratch) noexcept;

// The same for some of the nodes. What of z, carry and state belongs
// to the others is neither read nor written.
void network_step(const Network& network, const Graph& graph, std::span<const NodeRun> runs, const float* z,
                  const float* carry, float* state, float* scratch) noexcept;

// Largest |c| over all layers.
float largest_cell(const Network& network, uint32_t node_count, const float* state) noexcept;

}  // namespace sinew::tissue
