// level_name.hpp  A level of control graphs by its nodes: "20", "10 less 1" where it leaves a region out.
#pragma once
#include <algorithm>
#include <string>

#include "character/asset/graph_level.hpp"

namespace sinew::perf {

inline std::string level_name(const world::GraphLevel& level) {
  uint32_t most = 0;
  for (const pack::RegionRecord& region : level.pack.regions) most = std::max(most, region.node_count);
  const uint32_t without = level.regions_left_out();
  return std::to_string(most) + (without > 0 ? " less " + std::to_string(without) : "");
}

}  // namespace sinew::perf
