// cage_support.cpp  Which parts of a cage hang so loosely that nothing of their stiffness holds them.
#include "baker/truth/cage/cage_support.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "baker/truth/numerics/disjoint_sets.hpp"

namespace sinew::baker {
namespace {

constexpr double kInLine = 1e-6;  // sine of the angle between the sides of three nodes

using Tetrahedra = std::vector<std::array<int, 4>>;

DisjointSets parts_of(const Tetrahedra& tetrahedra) {
  DisjointSets parts(tetrahedra.size());
  std::map<std::array<int, 3>, size_t> first;
  for (size_t t = 0; t < tetrahedra.size(); ++t)
    for (size_t opposite = 0; opposite < 4; ++opposite) {
      std::array<int, 3> face{};
      for (size_t a = 0; a < 3; ++a) face[a] = tetrahedra[t][(opposite + 1 + a) % 4];
      std::ranges::sort(face);
      const auto [entry, added] = first.try_emplace(face, t);
      if (!added) parts.join(entry->second, t);
    }
  return parts;
}

// What a part is known to be held by: nodes until three of them are not in a line.
class Support {
 public:
  void add(const std::vector<Vector3>& nodes, int node) {
    const Vector3& p = nodes[static_cast<size_t>(node)];
    if (first_ < 0 || node == first_) {
      first_ = node;
    } else if (second_ < 0 || node == second_) {
      second_ = node;
    } else {
      const Vector3& from = nodes[static_cast<size_t>(first_)];
      const Vector3 side = nodes[static_cast<size_t>(second_)] - from, other = p - from;
      held_ |= side.cross(other).norm() > kInLine * side.norm() * other.norm();
    }
  }
  bool held() const { return held_; }

 private:
  int first_ = -1, second_ = -1;
  bool held_ = false;
};

}  // namespace

std::vector<bool> hinged_nodes(const std::vector<Vector3>& nodes, const Tetrahedra& tetrahedra,
                               const std::vector<bool>& constrained) {
  DisjointSets parts = parts_of(tetrahedra);
  std::vector<Support> support(tetrahedra.size());
  std::vector<bool> fixed = constrained, in_held(nodes.size(), false);
  for (bool grows = true; grows;) {
    grows = false;
    for (size_t t = 0; t < tetrahedra.size(); ++t)
      for (const int node : tetrahedra[t])
        if (fixed[static_cast<size_t>(node)]) support[parts.find(t)].add(nodes, node);
    for (size_t t = 0; t < tetrahedra.size(); ++t)
      for (const int node : tetrahedra[t])
        if (support[parts.find(t)].held() && !in_held[static_cast<size_t>(node)])
          in_held[static_cast<size_t>(node)] = fixed[static_cast<size_t>(node)] = grows = true;
  }
  in_held.flip();
  return in_held;
}

}  // namespace sinew::baker
