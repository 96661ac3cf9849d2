// rod_motion.hpp  Bones that are rods, tick by tick: what holds them, what shape they strive for, where they
// go.
//
// A rod's rest is the pose: its holder follows the bone that it hangs on, with the bone's velocity, and every
// joint's shape at rest is the one that the pose gives it, so that animated tails keep their animation and
// swing about it. Each segment feels gravity (g - (1 - sag) R g), R how the holder has turned since the bind
// pose: with sag 0 gravity has already bent what was posed, as in tissue.
//
// A rod whose end is held has a second holder there, which a joint of the pose moves.
//
// Rods live in the world's axes, from an anchor near the root. Where ticks were not followed (a start, a tier
// without simulation, dropped time) they are taken along: set to how they are shown, with the pose's
// velocity. A teleport moves anchor and rods rigidly with the root; those whose joints teleport are taken
// along, and keep what they swing with (character/motion/teleport.hpp).
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "character/instance.hpp"

namespace sinew::world {

// The next tick takes rods along; places count from near the coming root.
void begin_rods(Instance& instance) noexcept;
// Shifts rod_rest and rod_hold by one tick and puts the pose's in front.
void rest_rods(Instance& instance, const Matrix34* joints, const RootTransform& root) noexcept;
// A teleport from one root place to another, turned.
void move_rods(Instance& instance, const Eigen::Quaterniond& turn, const Eigen::Vector3d& from_m,
               const Eigen::Vector3d& to_m) noexcept;
// As if root and rods had come here so much faster, all the while.
void speed_rods(Instance& instance, const Eigen::Vector3d& added_m_s) noexcept;
// Of rods that are carried, in what the pose gives of the tick before (0) or of that before it (1).
void rest_carried_rods(Instance& instance, const Matrix34* joints, const RootTransform& root,
                       int tick) noexcept;
// Of the same, before their history is rebuilt: what they swing with.
void remember_rod_velocities(Instance& instance) noexcept;
// One tick, after rest_rods; rod_turn is its result.
// Of the root's acceleration they feel what tissue does (tissue::felt_share).
void simulate_rods(Instance& instance) noexcept;
// What rod_turn will be by a fraction x of the next tick, under the present pose
// (character/output/between_ticks.hpp); what sleeps stays, what is carried in that tick goes on as it went.
// turns: [slots][4].
void turn_rods_between(Instance& instance, float x, float* turns) noexcept;

}  // namespace sinew::world
