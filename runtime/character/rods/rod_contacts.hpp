// rod_contacts.hpp  What an instance's rods touch: a collider for each of its batches.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Where its ContactDef asks for it. Refused: no memory; *instance untouched.
Status make_rod_colliders(Instance& instance) noexcept;
// In the tier that it has (character/asset/affords_surface.hpp).
bool touches_surface(const Instance& instance) noexcept;
// Null where they touch nothing.
rods::RodCollider* rod_collider(Instance& instance, uint32_t batch) noexcept;
// After ticks that were not followed.
void forget_rod_contacts(Instance& instance) noexcept;
// Rods that sleep are woken by what comes near: one question, with a ball around them all; to the surface,
// which has their own skin in it, with each segment.
bool something_is_near_rods(Instance& instance) noexcept;

}  // namespace sinew::world
