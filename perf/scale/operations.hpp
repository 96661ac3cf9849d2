// operations.hpp  Multiply-adds that a character's equations ask for, padding not counted; in MFLOP, a
// multiply-add as two.
#pragma once
#include "pack/reader.hpp"

namespace sinew::perf {

inline double network_mflop(const pack::PackView& pack) {
  double a_node = 0, an_edge = 0;
  for (const pack::LayerRecord& layer : pack.layers) {
    const double inputs = layer.inputs, channels = layer.channels;
    a_node += channels * (4 * inputs * (1 + layer.has_self) + 7 * channels);
    an_edge += inputs + channels;  // P x, P h; of the last layer P y as well, of then and now
  }
  an_edge += 2 * pack.layers.back().channels;
  return 2e-6 * (a_node * static_cast<double>(pack.nodes.size()) +
                 an_edge * static_cast<double>(pack.graph_columns.size()));
}

inline double modal_mflop(const pack::PackView& pack, bool with_network) {
  double sum = 0;
  for (size_t r = 0; r < pack.regions.size(); ++r) {
    const double floats = 3.0 * pack.regions[r].node_count, modes = pack.region_modes[r].mode_count;
    sum += floats * floats + (with_network ? 4 : 3) * floats * modes;
  }
  return 2e-6 * sum;
}

inline double carry_mflop(const pack::PackView& pack) {
  double sum = 0;
  for (const pack::RegionRecord& region : pack.regions) sum += 3.0 * region.node_count * region.vertex_count;
  return 2e-6 * sum;
}

inline double character_mflop(const pack::PackView& pack) {
  return network_mflop(pack) + modal_mflop(pack, true) + carry_mflop(pack);
}

}  // namespace sinew::perf
