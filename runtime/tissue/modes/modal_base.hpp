// modal_base.hpp  A soft part as a few damped modes, in frames that turn with its flesh.
//
// For control node i: u displacement along its own frame R (tissue/frames/node_bend.hpp), l the same before
// warping, theta how its flesh has turned against its frame, f the felt acceleration
// (tissue/frames/node_drive.hpp); q modal coordinates. One tick, h long, from t-1 to t:
//   phi   = [R_t^T (2 R_{t-1} u_{t-1} - R_{t-2} u_{t-2}) - (2 u_{t-1} - u_{t-2})] / h^2
//   e     = exp([theta_{t-1}]x)^T (f + phi)
//   q^    = a1 q_{t-1} + a2 q_{t-2} + gain force e
//   r     = rest_a1 r_{t-1} + rest_a2 r_{t-2} + rest_gain rest e,   l^ = shape q^ + r
//   theta = turn q_t, |theta| held at 2 rad,          u_t = W(theta) l_t, held within the region's limit
//                                                     (tissue/modes/guard.hpp) where it is to be shown
// phi is what a frame that turns does to what moves in it (Coriolis, centrifugal and Euler, exact for the
// differences taken here). W(theta), the mean of the rotations from 0 to theta, is modal warping (Choi & Ko
// 2005): a bent tail stays as long as it was. r is the answer of the modes left out, exact at rest (residual
// flexibility; MacNeal 1971). On the modal base alone l = l^ and q = q^; a network corrects them by s p,
// q_t = q^ + s p and l_t = l^ + shape s p, and e is then turned by the theta of the base alone
// (tissue/modes/correction_budget.hpp). No simulated sequence enters: modes, shapes and forces are the
// flesh's own.
#pragma once
#include <cstdint>
#include <span>

#include "pack/pack_view.hpp"
#include "tissue/frames/node_pose.hpp"

namespace sinew::tissue {

inline constexpr float kLargestTurn_rad = 2;

// A region's modes: views into its pack, matrices as pack::RegionModesRecord has them.
struct ModalBase {
  std::span<const pack::ModeRecord> modes;
  uint32_t node_count = 0;
  uint32_t padded = 0, padded_modes = 0;          // floats of all nodes and of all modes in a row
  const float *shape = nullptr, *turn = nullptr;  // [modes][padded]
  const float* response = nullptr;                // [3 node_count][padded + padded_modes]
  const float* project = nullptr;                 // [3 node_count][padded_modes]
  float rest_a1 = 0, rest_a2 = 0, rest_gain = 0;
};
ModalBase modal_base(const pack::PackView& pack, size_t region) noexcept;

// phi of `count` nodes, m/s^2. pose, u, u_before: of these nodes; pose[0] is t, u is of t-1. Exactly zero
// while the frames do not turn. By a fraction x of the tick: (1 + x) u_{t-1} - x u_{t-2} goes on in the
// world, and pose[0] is of then.
void frame_term(const NodePose* const pose[3], const float* u, const float* u_before, float tick_s,
                uint32_t count, float* phi, float x = 1) noexcept;

// Of `count` nodes, three numbers each, out may be what is turned. theta within kLargestTurn_rad; exact to
// float.
void turn_back(const float* theta, const float* v, uint32_t count, float* out) noexcept;  // exp([theta]x)^T v
void warp(const float* theta, const float* l, uint32_t count, float* out) noexcept;       // W(theta) l

// What a tick goes on from: q [modes] and r [node_count][3] of the last two.
struct ModalState {
  const float *q, *q_before, *r, *r_before;
};
// Where it leads: q^ [modes], r [node_count][3], l^ [padded].
struct ModalAnswer {
  float *q, *r, *l;
};

// Below, heard and scratch are [padded + padded_modes], 64-byte aligned as l^ is. felt, e, l:
// [node_count][3].

// What a tick hears: rest e, then force e. felt is f + phi, and e comes out as above; they may be the same.
void modal_hear(const ModalBase& base, const float* felt, const float* theta, float* e,
                float* heard) noexcept;
// And what it answers.
void modal_answer(const ModalBase& base, const float* heard, const ModalState& state,
                  const ModalAnswer& answer) noexcept;
// q += project l.
void modal_project(const ModalBase& base, const float* l, float* q) noexcept;
// theta = turn q, held.
void modal_turn(const ModalBase& base, const float* q, float* scratch, float* theta) noexcept;

}  // namespace sinew::tissue
