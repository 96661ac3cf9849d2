// air.hpp  What moves an instance beside its pose: another gravity, an acceleration from outside, wind
// (sinew/parameters.hpp).
//
// Each number glides as a part's do (character/parameters/glide.hpp), from and to the sum of the world's
// Environment and the instance's own; its gravity counts as its change from the earth's, so that all zeros is
// as without. Flesh feels all of it as another gravity (tissue::add_pull); rods feel gravity as their recipe
// says, all of the acceleration, and the wind's drag bone by bone.
//   gusts  w (1 + gust n(c)), n three sines of c cycles. c goes on by gust_hz in the instance's own time, and
//          back as the root goes on downwind; where wind begins, c is how far upwind of the world's origin
//          the root is. So in a steady wind gusts reach one after the other, and nothing of it is a clock.
#pragma once
#include <Eigen/Core>

#include "character/instance.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::world {

inline bool tunes_air(const Instance& instance) noexcept {
  return (instance.state->parameters.tuned & kTunedAir) != 0;
}

// After its Environment or what was added to it may have changed, and of one that was made or restored.
void notice_environment(Instance& instance) noexcept;

// ---- in a step, of one that tunes_air (character/parameters/tuning.hpp) ----

void begin_air_tick(Instance& instance) noexcept;
void end_air_tick(Instance& instance) noexcept;  // ParameterMarks::moves; wakes rods
void settle_air(Instance& instance) noexcept;

// ---- what parts feel ----

// After a tick's drive.
void add_air(Instance& instance) noexcept;
// To f of a region's nodes by a fraction of the coming tick; their poses then and in the last tick.
struct FractionPoses {
  const tissue::NodePose *now, *before;
};
void add_air_between(const Instance& instance, size_t region, const FractionPoses& poses, float x,
                     float* felt) noexcept;

// m/s^2 on all of a rod in the coming tick, the earth's gravity not counted.
Eigen::Vector3d rod_pull(const Instance& instance, uint32_t rod) noexcept;
// Air where a rod is held, in the coming tick; zero: there is none.
Eigen::Vector3d air_at_rod(const Instance& instance, uint32_t rod) noexcept;
// On a bone that moves so, in newtons: at the tick's end as far as the bone alone can tell, so that it never
// outruns the air, however light it is.
Eigen::Vector3d drag_n(const RodSlot& slot, const rods::SegmentPose& pose,
                       const rods::SegmentVelocity& velocity, const Eigen::Vector3d& air_m_s,
                       double tick_s) noexcept;

}  // namespace sinew::world
