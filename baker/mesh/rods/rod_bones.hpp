// rod_bones.hpp  The segments of a bone chain or tree in the bind pose.
#pragma once
#include <optional>

#include "baker/mesh/rods/rods.hpp"

namespace sinew::baker {

// Joints of a chain or tree, by name for messages.
struct RodPlace {
  std::string where;       // "recipe: rod 'tail'"
  int root = 0, end = -1;  // end -1: all below the root
  int end_node = -1;       // below `end`'s: where its bone ends; -1: where its child is, else its end site
  double tail_m = 0;       // of a root that is alone: so long, away from its parent; 0: it is refused
  std::optional<Vector3> end_place = {};  // where `end`'s bone ends, before all that
};

// A radius made fit for a bone of this length.
double bone_radius_m(double radius_m, double length_m);

// Joints, parents, begin and end of each bone; radii as the flesh is thick on them. Throws BadInput as
// find_rods does.
std::vector<RodBone> segment_bones(const Character& character, const RodPlace& place);

}  // namespace sinew::baker
