// tree.hpp  A tree over a surface's triangles: built once, refitted as they move.
#pragma once
#include <span>
#include <vector>

#include "adapters/embree/topology.hpp"
#include "kernels/surface/surface_walk.hpp"

namespace sinew::embree {

class Tree {
 public:
  // groups: of each triangle, or none: all bits.
  void build(const Topology& topology, std::span<const float> places_m, std::span<const uint32_t> groups);
  // Corners go from `starts` by `moves`, [vertices][3], of which `drift` is not counted.
  void refit(const Topology& topology, std::span<const float> starts, std::span<const float> moves,
             const float (&drift)[3]) noexcept;

  uint32_t leaf_of(uint32_t triangle) const noexcept { return leaf_of_[triangle]; }
  simd::SurfaceTree view() const noexcept { return {nodes_, leaves_}; }
  // Of all boxes.
  const float (&low_m() const noexcept)[3] { return low_m_; }
  const float (&high_m() const noexcept)[3] { return high_m_; }
  size_t bytes() const noexcept;

 private:
  std::vector<simd::SurfaceNode> nodes_;  // each before its children
  std::vector<simd::SurfaceLeaf> leaves_;
  std::vector<uint32_t> leaf_of_;  // [triangles]
  float low_m_[3] = {0, 0, 0}, high_m_[3] = {0, 0, 0};
};

}  // namespace sinew::embree
