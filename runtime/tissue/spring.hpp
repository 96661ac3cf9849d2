// spring.hpp  Every control node on a damped spring of its own.
//
//   u_t = a1 u_{t-1} + a2 u_{t-2} + gain C f_t
// with f the felt acceleration (tissue/node_drive.hpp), C the node's static compliance and the recurrence of
// the region's first mode. Nodes do not know of each other, nor of their frames' turning.
#pragma once
#include <cstdint>

#include "pack/format.hpp"

namespace sinew::tissue {

// compliance: [count][9]. felt: the first three of each [stride] floats. u, u_before: [count][3], of t-1 and
// t-2; become t and t-1.
void spring_step(const pack::SpringRecord& spring, const float* compliance, const float* felt,
                 uint32_t stride, uint32_t count, float* u, float* u_before) noexcept;

}  // namespace sinew::tissue
