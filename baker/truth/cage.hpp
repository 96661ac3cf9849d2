// cage.hpp  A uniform voxel-tetrahedral cage around a surface, and the surface's barycentric place in it.
#pragma once
#include <array>
#include <vector>

#include "baker/import/character.hpp"
#include "baker/mesh/tissue_layout.hpp"

namespace sinew::baker {

struct Cage {
  std::vector<Vector3> nodes;                 // bind pose
  std::vector<std::array<int, 4>> tetrahedra; // positive volume
  std::vector<double> young_pa;               // a tetrahedron
  std::vector<Influences> skin;               // a node
  std::vector<bool> constrained;              // a node: follows the skinning
  double cell_m = 0;

  struct Place {
    int tetrahedron = 0;
    std::array<double, 4> weight{};
  };
  std::vector<Place> surface;  // a vertex of the character
};

Cage build_cage(const Character& character, const TissueLayout& layout, const Recipe& recipe);

}  // namespace sinew::baker
