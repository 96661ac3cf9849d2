// check_tissue.cpp  Regions, control nodes, the graph between them and their carrying weights.
#include <algorithm>
#include <cmath>

#include "pack/checks/checks.hpp"

namespace sinew::pack {
namespace {

constexpr uint32_t kMaxNodes = 4096;  // a region's; the runtime's scratch is sized by it
constexpr uint64_t kMostCarried = uint64_t{1}
                                  << 28;  // vertices of all regions, each padded: three floats each
// Baked ones are between 0 and 1, or little beyond.
constexpr float kMostWeight = 100;
// P of a graph with self-loops has none above 1.
constexpr float kMostOfGraph = 1 + 1e-3f;

Status check_record(const PackView& pack, const RegionRecord& region, size_t index) noexcept {
  if (Status status = check_name(pack, region.name, "region", index); !status.ok()) return status;
  if (region.node_count > kMaxNodes)
    return corrupt("region %zu: %u nodes, outside 0..4096", index, region.node_count);
  if (region.anchor_node >= std::max(region.node_count, 1u))
    return corrupt("region %zu: held at node %u of %u", index, region.anchor_node, region.node_count);
  if (region.padded_vertices != round_up_16(region.vertex_count))
    return corrupt("region %zu: vertices padded to %u", index, region.padded_vertices);
  if (!are_within(region.center_m, kFarthest_m))
    return corrupt("region %zu: centre is not within +-1e5 m", index);
  if (!is_within(region.radius_m, kLeastSize_m, kFarthest_m))
    return corrupt("region %zu: radius %g m, outside 1e-7..1e5", index, double{region.radius_m});
  if (!is_within(region.displacement_limit_m, kLeastSize_m, kFarthest_m))
    return corrupt("region %zu: displacement limit %g m, outside 1e-7..1e5", index,
                   double{region.displacement_limit_m});
  if (region.touches_body > 1)
    return corrupt("region %zu: touches_body is %u, neither 0 nor 1", index, region.touches_body);
  return {};
}

Status check_vertices(const PackView& pack, const RegionRecord& region, size_t index) noexcept {
  const auto vertices = pack.region_vertices.subspan(region.first_vertex, region.vertex_count);
  uint64_t next = 0;
  for (uint32_t vertex : vertices) {
    if (vertex < next || vertex >= pack.character->vertex_count)
      return corrupt("region %zu: vertex %u does not ascend or is not there", index, vertex);
    next = uint64_t{vertex} + 1;
  }
  return {};
}

Status check_carry(const PackView& pack, const RegionRecord& region, size_t index) noexcept {
  for (uint64_t node = 0; node < region.node_count; ++node) {
    const auto row = pack.carry.subspan(region.carry + node * region.padded_vertices, region.padded_vertices);
    if (!are_within(row, kMostWeight))
      return corrupt("region %zu: an embedding weight is not within +-100", index);
    if (std::ranges::any_of(row.subspan(region.vertex_count), [](float v) { return v != 0; }))
      return corrupt("region %zu: padding of the embedding weights is not zero", index);
  }
  return {};
}

// Where the next region's parts must start.
struct Cursor {
  uint64_t node = 0, vertex = 0, carry = 0, padded = 0;
};

// Ranges first: after this the region's parts can be read.
Status check_ranges(const PackView& pack, const RegionRecord& region, size_t index, Cursor* cursor) noexcept {
  const uint64_t carry = uint64_t{region.node_count} * region.padded_vertices;
  if (region.first_node != cursor->node || region.node_count > pack.nodes.size() - cursor->node)
    return corrupt("region %zu: nodes do not follow the region before it", index);
  if (region.first_vertex != cursor->vertex ||
      region.vertex_count > pack.region_vertices.size() - cursor->vertex)
    return corrupt("region %zu: vertices do not follow the region before it", index);
  if (region.carry != cursor->carry || carry > pack.carry.size() - cursor->carry)
    return corrupt("region %zu: embedding weights do not follow the region before it", index);
  if (cursor->padded + region.padded_vertices > kMostCarried)
    return corrupt("region %zu: more than 2^28 embedded vertices with those before it", index);
  *cursor = {cursor->node + region.node_count, cursor->vertex + region.vertex_count, cursor->carry + carry,
             cursor->padded + region.padded_vertices};
  return {};
}

Status check_regions(const PackView& pack) noexcept {
  Cursor cursor;
  for (size_t index = 0; index < pack.regions.size(); ++index) {
    const RegionRecord& region = pack.regions[index];
    if (Status status = check_record(pack, region, index); !status.ok()) return status;
    if (Status status = check_ranges(pack, region, index, &cursor); !status.ok()) return status;
    if (Status status = check_vertices(pack, region, index); !status.ok()) return status;
    if (Status status = check_carry(pack, region, index); !status.ok()) return status;
  }
  const bool whole = cursor.node == pack.nodes.size() && cursor.vertex == pack.region_vertices.size() &&
                     cursor.carry == pack.carry.size();
  return whole ? Status{} : corrupt("regions: nodes, vertices or embedding weights that no region owns");
}

// Within twice the radius, for whatever rounds.
bool is_inside(const RegionRecord& region, const NodeRecord& node) noexcept {
  const float away_m =
      std::hypot(node.position_m[0] - region.center_m[0], node.position_m[1] - region.center_m[1],
                 node.position_m[2] - region.center_m[2]);
  return away_m <=
         2 * region.radius_m + 1e-6f * std::hypot(node.position_m[0], node.position_m[1], node.position_m[2]);
}

Status check_nodes(const PackView& pack) noexcept {
  for (size_t index = 0; index < pack.nodes.size(); ++index) {
    const NodeRecord& node = pack.nodes[index];
    if (!are_within(node.position_m, kFarthest_m))
      return corrupt("node %zu: position is not within +-1e5 m", index);
    if (!is_unit(node.normal)) return corrupt("node %zu: normal is not a unit vector", index);
    if (!(node.stiffness >= 0 && node.stiffness <= 1))
      return corrupt("node %zu: stiffness %g, outside 0..1", index, double{node.stiffness});
    if (node.region >= pack.regions.size())
      return corrupt("node %zu: region %u of %zu", index, node.region, pack.regions.size());
    const RegionRecord& region = pack.regions[node.region];
    if (index < region.first_node || index - region.first_node >= region.node_count)
      return corrupt("node %zu: not among the nodes of its region %u", index, node.region);
    if (!is_inside(region, node))
      return corrupt("node %zu: beyond the radius of its region %u", index, node.region);
    if (Status status = check_skin(node.skin, pack.joints.size(), "node", index); !status.ok()) return status;
  }
  return {};
}

Status check_graph_row(const PackView& pack, size_t node) noexcept {
  const RegionRecord& region = pack.regions[pack.nodes[node].region];
  uint64_t next = region.first_node;
  for (uint32_t at = pack.graph_rows[node]; at < pack.graph_rows[node + 1]; ++at) {
    const uint32_t column = pack.graph_columns[at];
    if (column < next || column - region.first_node >= region.node_count)
      return corrupt("graph row %zu: column %u does not ascend or is of another region", node, column);
    next = uint64_t{column} + 1;
  }
  return {};
}

Status check_graph(const PackView& pack) noexcept {
  const size_t nodes = pack.nodes.size();
  if (pack.graph_rows[0] != 0 || pack.graph_rows[nodes] != pack.graph_columns.size())
    return corrupt("graph rows: do not cover the columns");
  if (!std::ranges::is_sorted(pack.graph_rows)) return corrupt("graph rows: not ascending");
  for (size_t node = 0; node < nodes; ++node)
    if (Status status = check_graph_row(pack, node); !status.ok()) return status;
  return check_within(pack.graph_values, kMostOfGraph, "graph values");
}

}  // namespace

Status check_tissue(const PackView& pack) noexcept {
  constexpr Check kChecks[] = {check_regions, check_nodes, check_graph};
  return run_checks(kChecks, pack);
}

}  // namespace sinew::pack
