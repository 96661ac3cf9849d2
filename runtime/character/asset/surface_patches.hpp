// surface_patches.hpp  A character's soft surface, cut up among its control nodes: what is asked for
// contacts.
//
// A vertex belongs to the node that carries most of it, of all regions. Vertices that are hardly carried
// belong to none: nothing pushes what is rigid, nor what a rod's bone moves.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "pack/pack_view.hpp"
#include "sinew/status.hpp"

namespace sinew::world {

struct SurfacePatches {
  struct Vertex {
    uint32_t index;    // of the character
    uint32_t carried;  // of its region's vertices: a column of its carry weights
    uint32_t also;     // in `others`, the first of the other regions that carry it; kNoIndex: none
    float area_m2;     // a third of its triangles', bind pose
  };
  struct Other {
    uint32_t index, region, carried;  // those of one vertex follow one another
  };
  std::unique_ptr<Vertex[]> vertices;  // a node after the other
  std::unique_ptr<uint32_t[]> first;   // [nodes + 1]
  std::unique_ptr<float[]> radii_m;    // [nodes]: how far a node's vertices lie from it, bind pose
  std::unique_ptr<Other[]> others;     // [other_count]
  uint32_t vertex_count = 0, other_count = 0;

  std::span<const Vertex> of(uint32_t node) const noexcept {
    return {vertices.get() + first[node], first[node + 1] - first[node]};
  }
};

// kOutOfCapacity: no memory. Cost: each carry weight is read once.
Status make_surface_patches(const pack::PackView& pack, SurfacePatches* out) noexcept;

}  // namespace sinew::world
