// own_body.hpp  Capsules about an instance's own bones, and its rods against them. Its soft parts:
// character/contacts/own_body_touches.hpp.
//
// Baked (pack::ProxyRecord). Each moves as its bone's skin does. What a rod grows
// out of it goes through for ever: a capsule that a segment and all between it and the rod's root touch in
// the bind pose. Turning about a capsule's own axis moves nothing.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "character/instance.hpp"

namespace sinew::world {

// 0 where the instance does not collide with its body.
uint32_t proxy_count(const Instance& instance) noexcept;
// Of what each segment goes through, once, of a batch's collider.
void pass_proxies(const Instance& instance, uint32_t batch, rods::RodCollider& collider) noexcept;
// Puts the pose's ends in front; behind it stay those of the tick before or, where rods sleep, of when they
// fell asleep, so that what creeps wakes them too.
void pose_proxies(Instance& instance, const Matrix34* joints, const RootTransform& root) noexcept;
// Those of the tick before the last.
void move_last_proxies(Instance& instance, const Eigen::Vector3d& by_m) noexcept;
// As the rods are turned in a teleport.
void turn_proxies(Instance& instance, const Eigen::Quaterniond& turn,
                  const Eigen::Vector3d& centre_m) noexcept;
// For the coming tick, with their velocities.
void set_proxies(Instance& instance, rods::RodCollider& collider) noexcept;
// Rods that sleep are woken.
bool proxies_move(const Instance& instance) noexcept;

}  // namespace sinew::world
