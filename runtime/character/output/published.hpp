// published.hpp  What a step leaves for whoever reads: displacement at nodes and at vertices.
#pragma once
#include <cstdint>

#include "character/asset/asset.hpp"
#include "core/arena.hpp"

namespace sinew::world {

struct Published {
  float* shown_between = nullptr;  // [nodes][3]: character/output/between_ticks.hpp
  float* delta = nullptr;          // [nodes][3], bind-pose axes
  float* carried = nullptr;        // of delta: a region after the other [3][padded_vertices], bind-pose axes
  float carried_share = 1;         // of `carried`, in what is read: a tail that fades is not carried anew
  uint32_t carried_level = 0;      // by whose weights it was carried
  bool carries_seam = false;       // `carried` has some of the seam in it
  float* surface = nullptr;        // [vertices][3], scratch of read_normals
  float* areas = nullptr;          // the same
};

void lay_out_scratch(const Asset& asset, core::Arena& arena, Published& to) noexcept;

}  // namespace sinew::world
