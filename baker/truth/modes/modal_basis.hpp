// modal_basis.hpp  A region's lowest modes, from the cage's eigenproblem, as its control nodes see them.
//
// About the unstressed shape, in axes that turn with the flesh, tissue driven by a felt acceleration f obeys
//   q_k'' + 2 zeta_k w_k q_k' + w_k^2 q_k = sum_i force(k, i) . f_i,   u_i = sum_k shape(i, k) q_k + r_i
// where r is what the modes left out would add. They answer together, as one oscillator at the frequency of
// the first of them that is exact at rest (residual flexibility; MacNeal 1971):
//   r'' + 2 zeta w r' + w^2 r = w^2 rest f
// with f_i at the control nodes, from which all flesh's is estimated (load_weights.hpp). The modes are those
// of the whole body of flesh that the region lies in, so that a part of it swings as the others let it, and
// their damping is the body's; the other regions hear the same motion at nodes of their own. No simulated
// sequence is needed.
#pragma once
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/truth/cage/cage.hpp"
#include "baker/truth/fem/fem.hpp"

namespace sinew::baker {

inline constexpr int kMostModes = 32;       // a region
inline constexpr double kTurnShare = 0.75;  // of half a bending mode's curl: what it is warped by

struct ModalBasis {
  Eigen::VectorXd rad_per_s;      // w, ascending
  Eigen::VectorXd damping_ratio;  // zeta, of the Rayleigh damping
  Eigen::MatrixXd shape;          // (3 nodes, modes), bind-pose axes; the finest nodes' root mean square is 1
  Eigen::MatrixXd turn;   // (3 nodes, modes), rotation vectors that shape is warped by: half its curl through
                          // the flesh, times kTurnShare, less where the mode is shear rather than bending
  Eigen::MatrixXd force;  // (modes, 3 nodes)
  Eigen::MatrixXd rest;   // (3 nodes, 3 nodes), s^2: what the modes left out answer to a steady felt
                          // acceleration
  double rest_rad_per_s = 0, rest_damping_ratio = 0;
  int anchor_node = 0;  // goes least far in its modes: where the region is held (tissue/frames/node_bend.hpp)
  double first_rad_per_s = 0, first_damping_ratio = 0;  // of the region with all else held still; 0: no modes
};

// cage_node: a node of `bodies` -> of the cage. One basis a region; fewer than `count` modes where a region
// has fewer (none: nothing of it is free to move) or, beyond the first six, fewer below 30 Hz. Of a coarser
// control graph the modes are the finest's, split among its regions, of its nodes' size and held where it is,
// and so are their q. Throws BadInput: count below 1.
std::vector<ModalBasis> modal_bases(const TissueLayout& layout, const Cage& cage,
                                    const std::vector<FemLinear>& bodies, const std::vector<int>& cage_node,
                                    int count, const TissueLayout* finest = nullptr);

}  // namespace sinew::baker
