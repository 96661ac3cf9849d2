// cage_support.hpp  Which parts of a cage hang so loosely that nothing of their stiffness holds them.
#pragma once
#include <array>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// Tetrahedra that share faces are one stiff part. A part is held where three of its nodes, not in a line, are
// constrained or belong to a held part; one that hangs on a corner or an edge swings about it as on a hinge,
// at no frequency. Returns for each node whether no held part has it. Cost: a sort of the faces.
std::vector<bool> hinged_nodes(const std::vector<Vector3>& nodes,
                               const std::vector<std::array<int, 4>>& tetrahedra,
                               const std::vector<bool>& constrained);

}  // namespace sinew::baker
