// root_motion.hpp  What of its root's motion an instance feels.
//
// The motion of the space that its poses name (a lift, a vehicle) is not felt, and of the rest only a share;
// nor is a change of scale. What is not felt moves the past along as a rigid body: the root before, the
// history of ticks, rods; so all that follows sees the felt motion alone, wherever the character is.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// The past rigidly from state.root to `root`: whatever the character feels and swings with stays.
void move_past(Instance& instance, const RootTransform& root) noexcept;

// In a step with a pose, before teleports are looked for: the past goes along with what is not felt.
void leave_out_unfelt(Instance& instance) noexcept;
// The space of the pose set last is the present one.
void keep_space(Instance& instance) noexcept;

}  // namespace sinew::world
