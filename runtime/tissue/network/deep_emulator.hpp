// deep_emulator.hpp  DeepEmulator's network on local patches (Zheng et al., CVPR 2021, Eq. 5): one step.
//
// u: dynamic, x: skinned positions of frame t, o = x_t(i), all relative to o of the node i that is predicted:
//   a(i)    = alpha(u_t - o, u_{t-1} - o, u_{t-2} - o, x_{t+1} - o, x_{t-1} - o of i; k, m, k/m of i)
//   b(i)    = sum over neighbours j of beta(the first five of i; u_t - o, u_{t-1} - o, u_{t-2} - o,
//             x_{t+1} - o, x_t - o, x_{t-1} - o of j; k, m, k/m of j; 1 if j is constrained)
//   u_{t+1} = u_t + gamma(a, b); of a constrained node x_{t+1}
// alpha, beta, gamma: four hidden layers with tanh and one without, 18 -> w -> w, 37 -> 2 w -> 2 w,
// 3 w -> 3 w -> 3; w is 64 in the paper, 16, 32 or 48 in smaller ones.
// A network that was trained so sees a patch from a frame that goes on as node i did, falls as it falls, and
// has axes and a unit of length of its own. With v = u_t - u_{t-1} and g of i, everything of tick t + s is
// seen at p - o - s v - s (s + 1) g / 2, and u_{t+1} = u_t + v + g + gamma(a, b): what would go on as it went
// is no part of what has to be learned, and by Galileo nothing else changes. u_{t-2} is then where going on
// leads back to, 2 u_{t-1} - u_t, so that a caller keeps two ticks. What of them is linear is done once a
// node, not once a neighbour: the centre's part of beta's first layer and beta's last layer, behind the sum.
// That leaves four fifths of the multiply-adds at twelve neighbours.
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

// Who is a node's neighbour, in CSR; both directions. A node that is listed as its own is passed over.
struct Neighbours {
  const uint32_t* rows = nullptr;  // [nodes + 1]
  const uint32_t* columns = nullptr;
};

// How a node's patch is seen. Rows of axes: what is seen of a vector is length^-1 axes v.
struct PatchView {
  float axes[9];   // orthonormal
  float length_m;  // > 0
  float
      fall_m[3];  // a tick^2, along the arrays' axes: what the node is accelerated by, as everything near it
};

// What a step is fed, [nodes][3] each, metres. Material: stiffness k, mass m, k / m in the units of the
// weights' training. Constrained: not 0 where a node follows its skinned place.
struct DeepFrame {
  const float *u_now = nullptr, *u_before = nullptr;  // u_t, u_{t-1}
  const float* u_before_that = nullptr;               // u_{t-2}; not read where there are views
  const float *x_next = nullptr, *x_now = nullptr, *x_before = nullptr;  // x_{t+1}, x_t, x_{t-1}
  const float* material = nullptr;
  const uint8_t* constrained = nullptr;  // [nodes]
  const PatchView* views = nullptr;      // [nodes]; null: from where it is, along the arrays' axes
};

// u_{t+1} of nodes first .. last to u_next [nodes][3], which is none of the frame's arrays. Any cut into
// ranges gives the same bits, and so does every target with FMA; ranges may run on several threads at once,
// each with a scratch of its own [64-byte aligned]. Nodes of no neighbours hear a sum of zero. A NaN that a
// node is fed reaches its output. Allocates nothing. Cost, with w = 64: 0.37 MFLOP a node and 0.10 a
// neighbour, of nodes that are not constrained; by the square of w less with smaller ones.
size_t deep_emulator_scratch_floats() noexcept;
void deep_emulator_step(const DeepEmulator& network, const Neighbours& neighbours, const DeepFrame& frame,
                        uint32_t first, uint32_t last, float* u_next, float* scratch) noexcept;

}  // namespace sinew::tissue
