// modes_pack.hpp  Modal bases to the sections that the tiers modal and spring run on.
#pragma once
#include <cstdint>
#include <vector>

#include "baker/mesh/tissue_layout.hpp"
#include "baker/pack/pack_writer.hpp"
#include "baker/truth/modal_basis.hpp"

namespace sinew::baker {

// How time is cut: ticks of the network, and the backward Euler steps of the truth in each, whose numerical
// damping the recurrences share.
struct TickGrid {
  double rate_hz = 60;
  int substeps = 4;
};

// q_t = a1 q_{t-1} + a2 q_{t-2} + gain p: what backward Euler makes of q'' + 2 zeta w q' + w^2 q = p, p
// constant over a tick. With h = 1 / (rate substeps), d = 1 + 2 zeta w h + w^2 h^2 and M of a substep on
// (q, q'),
//   M = [1 - h^2 w^2 / d, h / d; -h w^2 / d, 1 / d]   a1 = tr M^s   a2 = -det M^s   gain = (1 - a1 - a2) /
//   w^2
// a1 and a2 are rounded to float first: the static answer is then p / w^2 in float too. w = 0: nothing is
// remembered, a1 = a2 = 0.
struct Recurrence {
  float a1 = 0, a2 = 0, gain = 0;
};
Recurrence modal_recurrence(double rad_per_s, double damping_ratio, const TickGrid& grid);

// Shapes are nearly dependent at few nodes: q of a displacement u is the least |shape q - u|^2 + kRidge nodes
// sum (w_k / w_1)^2 q_k^2, stiff modes last.
inline constexpr double kRidge = 1e-3;

// Throws BadInput: not one basis a region, one that does not fit its region, more than kMostModes modes,
// numbers that are not finite.
void check_modes(const TissueLayout& layout, const std::vector<ModalBasis>& modes);

// Behind what the sections kRegionModes, kModeMatrices and kCompliance hold, a control graph's part; with the
// first, kModes and kSprings. `modes` has one basis a region. Returns the floats of the matrices. Throws
// BadInput as check_modes does.
uint64_t add_modes(const TissueLayout& layout, const std::vector<ModalBasis>& modes, const TickGrid& grid,
                   bool first, PackWriter& pack);

}  // namespace sinew::baker
