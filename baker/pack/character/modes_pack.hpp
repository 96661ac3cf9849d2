// modes_pack.hpp  Modal bases to the sections that modes run on.
#pragma once
#include <cstdint>
#include <vector>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/pack/pack_writer.hpp"
#include "baker/truth/modes/modal_basis.hpp"

namespace sinew::baker {

// q_t = a1 q_{t-1} + a2 q_{t-2} + gain p: the poles of q'' + 2 zeta w q' + w^2 q = p, and its answer to a
// steady p. With h = 1 / rate_hz,
//   a1 = 2 e^(-zeta w h) cos(w h sqrt(1 - zeta^2))   a2 = -e^(-2 zeta w h)   gain = (1 - a1 - a2) / w^2
// and cosh(w h sqrt(zeta^2 - 1)) where zeta > 1. a1 and a2 are rounded to float first: the static answer
// is then p / w^2 in float too. What swings by half a turn and more in a tick answers at once, and w = 0
// nothing: a1 = a2 = 0. Undamped, a2 is the float next to -1.
struct Recurrence {
  float a1 = 0, a2 = 0, gain = 0;
};
Recurrence modal_recurrence(double rad_per_s, double damping_ratio, double rate_hz);

// Shapes are nearly dependent at few nodes: q of a displacement u is the least |shape q - u|^2 + kRidge nodes
// sum (w_k / w_1)^2 q_k^2, stiff modes last.
inline constexpr double kRidge = 1e-3;

// Throws BadInput: not one basis a region, one that does not fit its region, more than kMostModes modes,
// numbers that are not finite.
void check_modes(const TissueLayout& layout, const std::vector<ModalBasis>& modes);

// Behind what the sections kRegionModes and kModeMatrices hold, a control graph's part; with the first,
// kModes as well. `modes` has one basis a region. Returns the floats of the matrices. Throws BadInput as
// check_modes does.
uint64_t add_modes(const TissueLayout& layout, const std::vector<ModalBasis>& modes, double rate_hz,
                   bool first, PackWriter& pack);

}  // namespace sinew::baker
