// drive.hpp  What moves a control node, split into parts along its region frame's axes.
//
// A region's frame: R, the rotation of the frame joint's skin matrix S = posed x inverse bind with scale
// taken out (Gram-Schmidt on the columns), and p = root S c, the place of the region's bind centre c. r = R^T
// (X - p), X a node's skinned place. With ticks h apart, backward differences (the future is not known at run
// time):
//   a            = R_t^T (p_t - 2 p_{t-1} + p_{t-2}) / h^2
//   omega        = log(R_{t-1}^T R_t) / h
//   alpha        = (omega_t - omega_{t-1}) / h
//   articulation = R_t^T (R_{t-2} (r_{t-2} - r_t) - 2 R_{t-1} (r_{t-1} - r_t)) / h^2
// Articulation is what skinning adds inside the frame, relative and Coriolis; it is exactly zero while r
// stands still. Tissue feels the other sign of each: -a, -alpha x r, -omega x (omega x r), -articulation. The
// trainer's data sets are written through this same code, so network and runtime cannot disagree on an input.
#pragma once
#include <cstdint>
#include <span>

namespace sinew::tissue {

// Three numbers each: linear, Euler, centrifugal, articulation (felt accelerations, m/s^2), angular
// acceleration (rad/s^2), angular velocity (rad/s), gravity change (m/s^2).
inline constexpr int kDriveWidth = 21;

// A region's frame at one tick, in double: the world may be far from the origin.
struct RegionFrame {
  double place_m[3];   // p, world
  double rotation[9];  // R, row-major, world-from-region
};

// Frames of the last three ticks, newest first; a region at rest holds three equal ones.
struct RegionMotion {
  RegionFrame frame[3];
};

// Shifts the history: frame[0] becomes `now`.
void push_frame(RegionMotion* motion, const RegionFrame& now) noexcept;

// Drives of a region's nodes. r_now, r_before, r_before2: [count][3] region-frame places of the last three
// ticks, metres. out: [count][kDriveWidth], m/s^2 and rad. gravity in the world along -Y; in the bind pose
// along the region frame's -Y.
void compute_drive(const RegionMotion& motion, float tick_s, const float* r_now, const float* r_before,
                   const float* r_before2, uint32_t count, float* out) noexcept;

// R and p of a frame joint. skin: posed x inverse bind (3x4 row-major, character space); root as in
// sinew::RootTransform.
RegionFrame region_frame(const float skin[12], const float center_m[3], const double root_position_m[3],
                         const float root_rotation_xyzw[4]) noexcept;

// r of nodes from their skinned places in character space ([count][3]; the root cancels). skin, center_m: as
// above.
void region_places(const float skin[12], const float center_m[3], const float* skinned_m, uint32_t count,
                   float* r) noexcept;

}  // namespace sinew::tissue
