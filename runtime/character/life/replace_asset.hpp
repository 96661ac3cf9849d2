// replace_asset.hpp  An instance goes on as one of the same character baked anew.
//
// Poses, root, time and what an engine set are taken over. What is shown of flesh and rods becomes the tail
// of a simulation that was left in this moment, node by node and bone by bone: so it begins anew from there,
// and is blended in, as after a gap (character/transition/blend.hpp).
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// kInvalidArgument: other joints, by number, names or parents.
Status check_same_skeleton(const Asset& from, const Asset& to) noexcept;

// `to` was made of the other asset, by the same definition.
void go_on_as(const Instance& from, Instance& to) noexcept;

}  // namespace sinew::world
