// topology.hpp  How a surface's triangles hang together.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sinew::embree {

inline constexpr uint32_t kBorder = ~0u;

using Corners = std::array<uint32_t, 3>;

struct Topology {
  std::vector<Corners> triangles;        // vertices; of those at one place the first
  std::vector<uint32_t> source;          // of each, its index in what was given
  std::vector<Corners> across;           // the triangle across the edge from corner k to the next, or kBorder
  std::vector<uint32_t> fan_begin, fan;  // triangles about each vertex
  std::vector<uint8_t> border;           // of each vertex: on an edge without two triangles that agree
  uint32_t skipped = 0;                  // triangles without area
  uint32_t border_edges = 0;
};

// Indices must be there and places finite.
Topology connect(std::span<const uint32_t> indices, std::span<const float> places_m);

}  // namespace sinew::embree
