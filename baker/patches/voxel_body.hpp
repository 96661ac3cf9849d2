// voxel_body.hpp  Bodies of voxels to learn from: a shape on a grid, cut into tetrahedra as cages are.
//
// Lengths in cells, mass in what a full cell has. A voxel weighs and resists by the share of it that lies in
// the shape, and its five tetrahedra change hands from voxel to voxel, as a cage's do
// (baker/truth/cage/cage_topology.hpp).
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "baker/truth/motion/random.hpp"

namespace sinew::baker {

enum class BodyShape {
  kSphere,    // held by a core in its middle
  kCylinder,  // held at one end
  kEar,       // flat and tapering, held at its root
  kSlab,      // flesh on a plate
  kLimb,      // flesh around a bone
};
inline constexpr const char* kBodyShapes[] = {"sphere", "cylinder", "ear", "slab", "limb"};

struct VoxelBody {
  std::vector<Vector3> nodes;
  std::vector<std::array<int, 4>> tetrahedra;  // positive volume
  std::vector<double> fill;                    // a tetrahedron, above 0
  std::vector<bool> constrained;               // a node
  double depth = 0;                            // of flesh beyond what holds it
};

// `size`: the sphere's radius; of the others about how far flesh reaches; 2 and more. Proportions and how
// much is held are drawn from `random`.
VoxelBody make_body(BodyShape shape, double size, Random& random);

// Pairs of nodes that share a tetrahedron, ascending, each once.
std::vector<std::pair<int, int>> edges_of(const std::vector<std::array<int, 4>>& tetrahedra);

}  // namespace sinew::baker
