// rod_end.hpp  Where a strap is sewn on: the bone that holds the end of a rod's last bone as well.
#pragma once
#include <optional>
#include <vector>

#include "baker/mesh/rods/rods.hpp"

namespace sinew::baker {

struct SewnEnd {
  int joint = -1;                   // that holds the end
  Vector3 place = Vector3::Zero();  // of the end, bind pose: the middle of the joint's skin along the seam
};

// Whether each bone of a rod hangs on the one before.
bool is_chain(const Rod& rod);

// By the skin alone, and only where it leaves no doubt: at the far end of a chain of two bones or more the
// last one's skin goes on to that of one bone, which `on_rods` (joints that rods move) leaves alone and which
// does not hold the chain's beginning; no other bone of the chain touches it.
std::optional<SewnEnd> find_sewn_end(const Character& character, const Rod& rod,
                                     const std::vector<bool>& on_rods);

// The middle of the joint's skin that touches the last bone's; none where they do not touch.
std::optional<Vector3> find_seam(const Character& character, const Rod& rod, int joint,
                                 const std::vector<bool>& on_rods);

}  // namespace sinew::baker
