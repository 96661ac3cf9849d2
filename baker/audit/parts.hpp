// parts.hpp  The soft parts and rods of a pack, and what of its surface is whose.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pack/reader.hpp"

namespace sinew::baker {

struct AuditedPart {
  std::string name;
  bool is_rod = false;
  double size_m = 0;    // a region's radius; a rod's longest way from root to tip
  double first_hz = 0;  // NaN for a rod
  size_t triangles = 0;
};

struct AuditedParts {
  static constexpr int kNone = -1;
  struct Edge {
    uint32_t a, b;
    int part;
    double bind_m;
    // Times its length: of how it is skinned, or, where a pose presses it together, of the bind pose, in
    // which its texture was painted.
    double stretch(double skinned_m, double shown_m) const { return shown_m / std::max(skinned_m, bind_m); }
  };
  std::vector<AuditedPart> all;  // regions, then rods
  size_t regions = 0;
  std::vector<int> of_vertex;                      // by which the vertex is moved, or kNone
  std::vector<Edge> edges;                         // each once, of which an end is a part's
  std::vector<std::array<uint32_t, 3>> triangles;  // of which a corner is a part's
  std::vector<int> of_triangle;
};

AuditedParts find_parts(const pack::PackView& character);

}  // namespace sinew::baker
