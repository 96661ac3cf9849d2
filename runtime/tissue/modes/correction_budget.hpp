// correction_budget.hpp  How much of a network's correction a region takes, so that no weights can do harm.
//
// d is what corrections have moved the modal coordinates q by, as modes go on with it; b = q - d is the modal
// base alone. With w_m = 1 / (1 - a1 - a2) of a mode,
//   S(x, y) = sum_m w_m (x_m^2 - a1 x_m y_m - a2 y_m^2)
// is an energy of d and of what it was a tick before: a freely swinging underdamped mode loses the share
// 1 + a2 of it in a tick (x = r^t cos(wt + f) has x^2 - 2 r cos w x y + r^2 y^2 falling by r^2). A tick's
// correction p is scaled by the largest s in [0, 1] for which
//   S(d- + s p, d) <= k^2 swing,   d- = a1 d + a2 d_before,   k = kMostCorrection
//   swing = max(|b|^2, L swing), L = max_m(-a2); only L swing while the pose stays as it is.
// s = 0 keeps the bound by induction, so S(d) <= k^2 swing for any finite p. Hence d swings at most k times
// as far as the base did of late, and under a pose that stays it vanishes at the base's own pace.
#pragma once
#include <span>

#include "pack/format.hpp"

namespace sinew::tissue {

inline constexpr float kMostCorrection = 0.5f;  // k: 0.35 costs the shipped network 2 % in a shake, 0.25 22 %

struct CorrectionStep {
  std::span<const pack::ModeRecord> modes;  // p is zero of those that do not swing
  const float* base = nullptr;              // [modes] b of this tick
  const float* d = nullptr;                 // [modes] of the last tick
  const float* d_before = nullptr;          // [modes] of the tick before it
  const float* correction = nullptr;        // [modes] p
  bool pose_stays = false;                  // it is that of the last two ticks
};

// s. swing is the region's, of the last tick; it becomes this tick's. Not finite: 0. Cost: 12 operations a
// mode.
float bounded_share(const CorrectionStep& step, float* swing) noexcept;

}  // namespace sinew::tissue
