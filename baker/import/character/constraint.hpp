// constraint.hpp  Nodes that follow others (VRMC_node_constraint 1.0).
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// Turns constrained nodes of `posed` as their sources are, from what these are at rest. A node is turned
// after what it depends on; in a circle the first one's source counts as it was posed.
void follow_constraints(const std::vector<Node>& rest, std::vector<Node>& posed);

}  // namespace sinew::baker
