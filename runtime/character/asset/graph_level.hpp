// graph_level.hpp  One control graph of a character: a whole tissue of its own, finest first in the asset.
#pragma once
#include <memory>

#include "character/asset/surface_patches.hpp"
#include "tissue/frames/fraction_step.hpp"
#include "tissue/network/network_weights.hpp"

namespace sinew::world {

struct GraphLevel {
  pack::PackView pack;  // with this level in view
  tissue::Graph graph;
  std::unique_ptr<tissue::SwingSlopes[]> swing_slopes;  // of each region's modes, and of its rest behind them
  SurfacePatches patches;                               // made with the first instance that has contacts

  uint32_t node_count() const noexcept { return static_cast<uint32_t>(pack.nodes.size()); }
  uint32_t mode_count() const noexcept { return static_cast<uint32_t>(pack.modes.size()); }
  // It has no nodes there: the region is skinned.
  bool leaves_out(size_t region) const noexcept { return pack.regions[region].node_count == 0; }
  uint32_t regions_left_out() const noexcept {
    uint32_t count = 0;
    for (size_t r = 0; r < pack.regions.size(); ++r) count += leaves_out(r);
    return count;
  }
};

}  // namespace sinew::world
