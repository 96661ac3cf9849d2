// deep_emulator.hpp  DeepEmulator's network on local patches (Zheng et al., CVPR 2021, Eq. 5): one step.
//
// u: dynamic, x: skinned positions of frame t, o = x_t(i), all relative to o of the node i that is predicted:
//   a(i)    = alpha(u_t - o, u_{t-1} - o, u_{t-2} - o, x_{t+1} - o, x_{t-1} - o of i; k, m, k/m of i)
//   b(i)    = sum over neighbours j of beta(the first five of i; u_t - o, u_{t-1} - o, u_{t-2} - o,
//             x_{t+1} - o, x_t - o, x_{t-1} - o of j; k, m, k/m of j; 1 if j is constrained)
//   u_{t+1} = u_t + gamma(a, b); of a constrained node x_{t+1}
// alpha, beta, gamma: four hidden layers with tanh and one without, 18 -> 64 -> 64, 37 -> 128 -> 128,
// 192 -> 192 -> 3. What of them is linear is done once a node, not once a neighbour: the centre's part of
// beta's first layer and beta's last layer, behind the sum. That leaves four fifths of the multiply-adds at
// twelve neighbours.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "pack/format.hpp"

namespace sinew::tissue {

struct DeepEmulator {  // views into a pack; trivially copyable
  std::span<const pack::DenseRecord> layers;
  const float* weights = nullptr;
};

// Who is a node's neighbour, in CSR; both directions, no self-loops.
struct Neighbours {
  const uint32_t* rows = nullptr;  // [nodes + 1]
  const uint32_t* columns = nullptr;
};

// What a step is fed, [nodes][3] each, metres. Material: stiffness k, mass m, k / m in the units of the
// weights' training. Constrained: not 0 where a node follows its skinned place.
struct DeepFrame {
  const float *u_now = nullptr, *u_before = nullptr, *u_before_that = nullptr;  // u_t, u_{t-1}, u_{t-2}
  const float *x_next = nullptr, *x_now = nullptr, *x_before = nullptr;         // x_{t+1}, x_t, x_{t-1}
  const float* material = nullptr;
  const uint8_t* constrained = nullptr;  // [nodes]
};

// u_{t+1} of nodes first .. last to u_next [nodes][3], which is none of the frame's arrays. Any cut into
// ranges gives the same bits, and so does every target with FMA; ranges may run on several threads at once,
// each with a scratch of its own [64-byte aligned]. Nodes of no neighbours hear a sum of zero. A NaN that a
// node is fed reaches its output. Allocates nothing. Cost: 0.37 MFLOP a node and 0.10 a neighbour, of nodes
// that are not constrained.
size_t deep_emulator_scratch_floats() noexcept;
void deep_emulator_step(const DeepEmulator& network, const Neighbours& neighbours, const DeepFrame& frame,
                        uint32_t first, uint32_t last, float* u_next, float* scratch) noexcept;

}  // namespace sinew::tissue
