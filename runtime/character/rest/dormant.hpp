// dormant.hpp  A character that is asleep under a pose that does not change is not stepped.
//
//   dormant  every region and rod sleeps, it asks no source (its own body stands still with its pose),
//   nothing fades, and for kStillTicks ticks the
//            pose set was bit for bit the present one, or none was set.
//   up again with another pose, a budget of 0, another limit of its tier, a reset, or out of sight; it goes
//            on as if it had been stepped meanwhile.
// It keeps its tier, the best or not, and is told as asleep; a step takes only its clock on.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// The pose last set is the one the instance has.
bool has_pose(const Instance& instance, std::span<const Matrix34> joints, const RootTransform& root) noexcept;

// In its step, after take_pose: counts ticks under an unchanged pose.
void watch_pose(Instance& instance) noexcept;
// After its ticks: dormant from the next step on, where it may be.
void fall_dormant(Instance& instance) noexcept;
// In place of a step.
void stay_dormant(Instance& instance, double frame_s) noexcept;  // by its plan's ticks

}  // namespace sinew::world
