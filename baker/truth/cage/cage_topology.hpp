// cage_topology.hpp  Voxel copies, their shared nodes and tetrahedra: a cage before it has skin or material.
#pragma once
#include "baker/truth/cage/cage.hpp"
#include "baker/truth/cage/voxel_matter.hpp"

namespace sinew::baker {

class CageTopology {
 public:
  explicit CageTopology(const VoxelMatter& matter);

  std::vector<Vector3> nodes;
  std::vector<std::array<int, 4>> tetrahedra;  // five a voxel copy
  std::vector<double> fill;                    // a tetrahedron

  // Where a place on the surface sits: in the copy of the matter under it.
  Cage::Place place(const Vector3& surface, const Vector3& inward) const;

 private:
  void copy_voxels();
  void share_nodes();
  void split();
  int nearest_copy(const Vector3& p) const;

  const VoxelMatter& matter_;
  struct Copy {
    int coarse = 0, fine_cells = 0;
    std::array<int, 8> node{};
  };
  std::vector<int> copy_of_fine_;  // -1: no matter
  std::vector<Copy> copies_;
};

}  // namespace sinew::baker
