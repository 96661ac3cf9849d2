// node_drive.hpp  What moves a control node, as it feels it: along the axes of its own frame
// (tissue/frames/node_bend.hpp).
//
// With x its skinned place in the world, R its frame, g gravity, and ticks h apart, backward differences (the
// future is not known at run time); bend is what its flesh is turned beyond R, and so exp([bend]x) g gravity
// as the bound flesh bears it:
//   felt acceleration  f     = R_t^T (g - (x_t - 2 x_{t-1} + x_{t-2}) / h^2) - exp([bend_t]x) g
//   gravity change           = R_t^T g - exp([bend_t]x) g
//   angular velocity   omega = vee((A - A^T) / 2) / h,  A = R_{t-1}^T R_t     the sine of a tick's turn
//   angular acceleration     = (omega_t - omega_{t-1}) / h
//   bend                     of t: a quarter of the region's bend (tissue/frames/node_bend.hpp)
// All are zero for a character that stands still in its bind pose. The trainer's data sets are written
// through this same code, so network and runtime cannot disagree on an input.
#pragma once
#include <cstdint>
#include <limits>

#include "tissue/frames/node_pose.hpp"

namespace sinew::tissue {

// Three numbers each: felt acceleration and gravity change (m/s^2), angular velocity (rad/s), angular
// acceleration (rad/s^2), bend (rad).
inline constexpr int kNodeDriveWidth = 15;

// The last three ticks, newest first; a character at rest holds three equal ones. Views.
struct NodeMotion {
  double root_position_m[3][3];  // [tick]
  const NodePose* pose[3];       // [tick][node]
  // What of (x_t - 2 x_{t-1} + x_{t-2}) / h^2 is felt: felt_share below; infinity: all of it.
  float most_m_s2 = std::numeric_limits<float>::infinity();
  // [node]: how many times as large as in the bind pose its flesh is; what it feels of acceleration is
  // divided by that, so that in the bind pose's metres it swings alike at every size. Null: 1.
  const float* size = nullptr;
};

// Of an acceleration: 1 up to half of the most, from there smoothly less, so that the most is approached.
float felt_share(float acceleration_m_s2, float most_m_s2) noexcept;

// out: [count][kNodeDriveWidth].
void compute_node_drive(const NodeMotion& motion, float tick_s, uint32_t count, float* out) noexcept;

// Its f alone by a fraction x of a tick, 0 < x <= 1 (tissue/frames/fraction_step.hpp): motion has the present
// pose, then those of the last two ticks. out: [count][3].
void fraction_felt(const NodeMotion& motion, float tick_s, float x, uint32_t count, float* out) noexcept;

// What pulls at all of a part's nodes alike beside the gravity that its flesh was baked under, m/s^2 in the
// world: R_t^T pull more in f and in the gravity change, as another gravity would have it. drive: [count].
void add_pull(const NodePose* now, const float* pull_m_s2, uint32_t count, float* drive) noexcept;
// The same of fraction_felt: `pull` by then, and that of the last tick, whose poses are `before`.
struct PulledNodes {
  const NodePose *now, *before;
  uint32_t count;
};
void add_fraction_pull(const PulledNodes& nodes, const float* pull_m_s2, const float* pull_before_m_s2,
                       float x, float* felt) noexcept;

}  // namespace sinew::tissue
