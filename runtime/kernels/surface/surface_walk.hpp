// surface_walk.hpp  A tree over the triangles of a deforming surface, and what is found by walking it.
//
// Boxes hold each triangle's way through a tick, less `drift`, which all of the surface goes on the way. What
// is found is by bounds in float that are never above the true distances, so that whoever looks at it in
// double comes to the same on every target.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace sinew::simd {

inline constexpr size_t kSurfaceWide = 8;  // children of a node, triangles of a leaf

// One a lane. Where there is none: low above high.
struct SurfaceBoxes {
  float low[3][kSurfaceWide], high[3][kSurfaceWide];
};

inline constexpr uint32_t kSurfaceLeaf = 1u << 31;  // of a child: the rest is a leaf's index, else a node's
struct alignas(64) SurfaceNode {
  SurfaceBoxes boxes;
  uint32_t children[kSurfaceWide];
};

struct alignas(64) SurfaceLeaf {
  float corners[3][3][kSurfaceWide];  // x y z of each corner where the tick begins
  float ends[3][3][kSurfaceWide];     // and where it ends, less the drift
  uint32_t triangles[kSurfaceWide];   // where there is none: the first once more, of no group
  uint32_t groups[kSurfaceWide];
};

struct SurfaceTree {
  std::span<const SurfaceNode> nodes;  // the first is the root
  std::span<const SurfaceLeaf> leaves;
};

// A walk that goes on: what is found is looked at, and the walk taken up again until it is done.
struct SurfaceWalk {
  static constexpr uint32_t kMostFound = 128, kMostPending = 80, kNoLeaf = ~0u;
  struct Pending {
    float square_m2;  // from the point to its box, at least; negative: the leaf that is looked at first
    uint32_t child;
  };

  uint32_t groups;      // triangles with none of these bits are passed over
  uint32_t first_leaf;  // as a child, or kNoLeaf
  uint32_t found_count, pending_count;
  uint32_t found[kMostFound];  // triangles
  // Of `nearest`: from the point; and whether the point is above the triangle's plane, beyond doubt.
  float at_least_m[kMostFound];
  bool above[kMostFound];
  Pending pending[kMostPending];

  void begin(uint32_t of_groups, uint32_t leaf = kNoLeaf) {
    groups = of_groups, first_leaf = leaf == kNoLeaf ? kNoLeaf : kSurfaceLeaf | leaf;
    found_count = 0, pending_count = 1;
    pending[0] = {0, 0};
    if (leaf != kNoLeaf) pending[pending_count++] = {-1, first_leaf};
  }
  bool done() const { return pending_count == 0; }
};

// All that may be as near to a point as what is nearest, or as within_m; the latter becomes less as triangles
// are found. rounding_m bounds what float does to places here.
struct SurfacePoint {
  float point_m[3];
  float rounding_m;
  float within_m;
};

// A capsule's axis on its way, less the drift; within_m of it at one time something must be to be found.
struct SurfaceSweep {
  float start_m[2][3], end_m[2][3];
  float low_m[3], high_m[3];  // about all that, and more by within_m
  float within_m;
  float share;  // of the triangles' way
};

struct SurfaceWalks {
  // Both: until the walk is done or there is no room for what may be found next. What was found before is
  // gone.
  void (*nearest)(const SurfaceTree& tree, SurfacePoint* of, SurfaceWalk* walk);
  // Triangles that no plane tells to be beyond that. There may be others.
  void (*near_sweep)(const SurfaceTree& tree, const SurfaceSweep& sweep, SurfaceWalk* walk);
};

}  // namespace sinew::simd
