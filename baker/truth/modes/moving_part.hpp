// moving_part.hpp  The tetrahedra of a cage that have a free node, renumbered: the rest only follows.
#pragma once
#include "baker/truth/cage/cage.hpp"
#include "baker/truth/fem/fem.hpp"

namespace sinew::baker {

struct MovingPart {
  std::vector<int> cage_node;     // a node here -> of the cage
  std::vector<int> node_of_cage;  // -1: not here
  std::vector<int> cage_element;  // a tetrahedron here -> of the cage
  std::vector<Vector3> rest;
  std::vector<std::array<int, 4>> tetrahedra;
  std::vector<bool> constrained;
  FemMaterial material;
};

MovingPart moving_part(const Cage& cage, const Recipe& recipe);

}  // namespace sinew::baker
