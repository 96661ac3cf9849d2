// cage.hpp  A uniform voxel-tetrahedral cage around a surface, and the surface's barycentric place in it.
//
// A voxel is copied for each separate piece of matter in it, and copies share nodes only where their matter
// meets (Nesme et al. 2009): parts that lie close, or touch without being joined, are not glued. A voxel
// weighs and resists by the share of it that is matter.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"

namespace sinew::baker {

struct Cage {
  std::vector<Vector3> nodes;                  // bind pose
  std::vector<std::array<int, 4>> tetrahedra;  // positive volume
  std::vector<double> young_pa;                // a tetrahedron; by stiffness and fill
  std::vector<double> fill;                    // a tetrahedron: share that is matter, above 0
  std::vector<Influences> skin;                // a node
  std::vector<double> stiffness;               // a node, 0 soft .. 1 rigid
  std::vector<bool> constrained;               // a node: follows the skinning
  double cell_m = 0;
  std::vector<std::string> notes;

  struct Place {
    int tetrahedron = 0;
    std::array<double, 4> weight{};  // sum 1; slightly negative where the vertex lies just outside
  };
  std::vector<Place> surface;  // a vertex of the character; of one that lies on another piece, where it does
};

// Free are the nodes around soft regions that are neither as stiff as the recipe's rigid_stiffness nor in a
// bone's core, and hang on constrained ones by more than a corner or an edge (cage_support.hpp). Where the
// recipe states no voxels_high, cells shrink until kFewFreeNodes are free, or as many as kMostVoxelsHigh
// give, and grow until at most kMostFreeNodes are, of which a note tells. Throws BadInput when none is free.
inline constexpr int kFewFreeNodes = 1500, kMostVoxelsHigh = 64;  // thin parts: two cells are no flesh
inline constexpr int kMostFreeNodes = 4000;  // with the short truths of a bake: a quarter of a minute
Cage build_cage(const Character& character, const TissueLayout& layout, const Recipe& recipe);

}  // namespace sinew::baker
