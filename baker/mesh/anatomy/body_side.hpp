// body_side.hpp  On which side of its bones a region is soft: a belly before the spine, or below one that
// lies.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/anatomy/anatomy.hpp"
#include "baker/mesh/anatomy/soft_kind.hpp"

namespace sinew::baker {

enum class BodySide { kAround, kFront, kBack, kAbove, kBelow, kInside, kOutside };

std::optional<BodySide> side_called(const std::string& name);  // "front", "back", ...; not "around"
std::string side_names();                                      // of all but kAround, for messages

// Of each vertex 0 .. 1: from 1 in the middle of the side to 0 at the bones and beyond. `joints`: the
// region's; `reached`: vertices that the region moves, of which the one farthest out on the side is its
// middle. side absent: the kind's own. Nothing where that is all around, where the character has no anatomy
// to tell sides by, and where nothing lies on that side.
std::optional<std::vector<double>> side_share(const Character& character,
                                              const std::optional<Anatomy>& anatomy, SoftKind kind,
                                              std::optional<BodySide> side, const std::vector<bool>& joints,
                                              const std::vector<bool>& reached);

}  // namespace sinew::baker
