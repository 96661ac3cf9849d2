// cage_topology.cpp  Voxel copies, their shared nodes and tetrahedra: a cage before it has skin or material.
#include "baker/truth/cage/cage_topology.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "baker/truth/cage/voxel_split.hpp"
#include "baker/truth/numerics/disjoint_sets.hpp"

namespace sinew::baker {
namespace {

constexpr double kLeastFill =
    0.2;  // a sliver must not become a feather: its mode would be the stiffest of all

std::array<int, 3> coarse_place(const VoxelMatter& matter, int coarse) {
  const auto cells = matter.cells();
  return {coarse % cells[0], coarse / cells[0] % cells[1], coarse / cells[0] / cells[1]};
}

// visit(fine, other) for all pairs of matter cells that hang together.
template <typename Visit>
void each_joint(const VoxelMatter& matter, const Visit& visit) {
  for (int fine = 0; fine < matter.fine_count(); ++fine) {
    if (!matter.matter(fine)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const int next = matter.neighbour(fine, axis);
      if (next >= 0 && matter.matter(next) && matter.connected(fine, axis)) visit(fine, next);
    }
  }
  for (const auto& [fine, other] : matter.links()) visit(fine, other);
}

// The corner of a voxel at `b` that lies where corner `corner` of a voxel at `a` does, -1 for none.
int same_corner(const std::array<int, 3>& a, const std::array<int, 3>& b, size_t corner) {
  int other = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const int bit = static_cast<int>(corner >> axis & 1) + a[axis] - b[axis];
    if (bit < 0 || bit > 1) return -1;
    other |= bit << axis;
  }
  return other;
}

Eigen::Vector4d barycentric(const std::vector<Vector3>& nodes, const std::array<int, 4>& t,
                            const Vector3& p) {
  const auto at = [&](size_t a) { return nodes[static_cast<size_t>(t[a])]; };
  Eigen::Matrix3d edges;
  edges << at(1) - at(0), at(2) - at(0), at(3) - at(0);
  const Vector3 w = edges.inverse() * (p - at(0));
  return {1 - w.sum(), w[0], w[1], w[2]};
}

}  // namespace

CageTopology::CageTopology(const VoxelMatter& matter) : matter_(matter) {
  copy_voxels();
  share_nodes();
  split();
}

void CageTopology::copy_voxels() {
  DisjointSets pieces(static_cast<size_t>(matter_.fine_count()));
  each_joint(matter_, [&](int fine, int next) {
    if (matter_.coarse_of(fine) == matter_.coarse_of(next))
      pieces.join(static_cast<size_t>(fine), static_cast<size_t>(next));
  });
  copy_of_fine_.assign(static_cast<size_t>(matter_.fine_count()), -1);
  for (int fine = 0; fine < matter_.fine_count(); ++fine) {
    if (!matter_.matter(fine)) continue;
    int& root = copy_of_fine_[pieces.find(static_cast<size_t>(fine))];
    if (root < 0) {
      root = static_cast<int>(copies_.size());
      copies_.push_back({matter_.coarse_of(fine), 0, {}});
    }
    copy_of_fine_[static_cast<size_t>(fine)] = root;
    ++copies_[static_cast<size_t>(root)].fine_cells;
  }
}

void CageTopology::share_nodes() {
  DisjointSets corners(copies_.size() * 8);
  each_joint(matter_, [&](int fine, int next) {
    const auto a = static_cast<size_t>(copy_of_fine_[static_cast<size_t>(fine)]);
    const auto b = static_cast<size_t>(copy_of_fine_[static_cast<size_t>(next)]);
    if (a == b) return;
    const auto at_a = coarse_place(matter_, copies_[a].coarse),
               at_b = coarse_place(matter_, copies_[b].coarse);
    for (size_t corner = 0; corner < 8; ++corner) {
      const int other = same_corner(at_a, at_b, corner);
      if (other >= 0) corners.join(8 * a + corner, 8 * b + static_cast<size_t>(other));
    }
  });
  std::vector<int> number(copies_.size() * 8, -1);
  for (size_t slot = 0; slot < number.size(); ++slot) {
    int& node = number[corners.find(slot)];
    const auto p = coarse_place(matter_, copies_[slot / 8].coarse);
    if (node < 0) {
      node = static_cast<int>(nodes.size());
      nodes.push_back(matter_.corner(p[0] + static_cast<int>(slot & 1),
                                     p[1] + static_cast<int>(slot >> 1 & 1),
                                     p[2] + static_cast<int>(slot >> 2 & 1)));
    }
    copies_[slot / 8].node[slot % 8] = node;
  }
}

void CageTopology::split() {
  const double whole = matter_.fine_per_cell() * matter_.fine_per_cell() * matter_.fine_per_cell();
  for (const Copy& copy : copies_) {
    const auto p = coarse_place(matter_, copy.coarse);
    for (const auto& corner : kVoxelSplit[static_cast<size_t>((p[0] + p[1] + p[2]) % 2)]) {
      std::array<int, 4> t{};
      for (size_t a = 0; a < 4; ++a) t[a] = copy.node[static_cast<size_t>(corner[a])];
      tetrahedra.push_back(t);
      fill.push_back(std::max(kLeastFill, copy.fine_cells / whole));
    }
  }
}

int CageTopology::nearest_copy(const Vector3& p) const {
  int best = 0;
  double nearest = std::numeric_limits<double>::max();
  for (size_t c = 0; c < copies_.size(); ++c) {
    const Vector3 middle = 0.5 * (nodes[static_cast<size_t>(copies_[c].node[0])] +
                                  nodes[static_cast<size_t>(copies_[c].node[7])]);
    const double distance = (middle - p).squaredNorm();
    if (distance < nearest) nearest = distance, best = static_cast<int>(c);
  }
  return best;
}

Cage::Place CageTopology::place(const Vector3& surface, const Vector3& inward) const {
  int copy = copy_of_fine_[static_cast<size_t>(matter_.home(surface, inward))];
  if (copy < 0) copy = nearest_copy(surface);  // a vertex of no triangle
  Cage::Place best;
  double depth = -std::numeric_limits<double>::max();
  for (int e = 5 * copy; e < 5 * copy + 5; ++e) {
    const Eigen::Vector4d w = barycentric(nodes, tetrahedra[static_cast<size_t>(e)], surface);
    if (w.minCoeff() <= depth) continue;
    depth = w.minCoeff();
    best.tetrahedron = e;
    best.weight = {w[0], w[1], w[2], w[3]};
  }
  return best;
}

}  // namespace sinew::baker
