// check_levels.cpp  Control graphs: cut out of the sections they share, each whole, coarser ones parts of
// finer.
#include <algorithm>

#include "pack/checks/checks.hpp"

namespace sinew::pack {
namespace {

constexpr float kMostSpread = 100;  // baked ones are between 0 and 1, or little beyond

// Takes the next `count` from what is left of a section. False: there are not so many.
template <class T>
bool take(std::span<const T>& rest, uint64_t count, std::span<const T>* out) noexcept {
  if (count > rest.size()) return false;
  *out = rest.first(count);
  rest = rest.subspan(count);
  return true;
}

bool take_level(const PackView& pack, uint32_t index, LevelView& rest, LevelView* out) noexcept {
  const LevelRecord& record = pack.level_records[index];
  const uint64_t nodes = record.node_count, regions = pack.character->region_count;
  return take(rest.regions, regions, &out->regions) && take(rest.nodes, nodes, &out->nodes) &&
         take(rest.graph_rows, nodes + 1, &out->graph_rows) &&
         take(rest.graph_columns, record.graph_entries, &out->graph_columns) &&
         take(rest.graph_values, record.graph_entries, &out->graph_values) &&
         take(rest.carry, record.carry_floats, &out->carry) &&
         take(rest.region_modes, regions, &out->region_modes) &&
         take(rest.mode_matrices, record.matrix_floats, &out->mode_matrices) &&
         take(rest.picks, index > 0 ? nodes : 0, &out->picks) &&
         take(rest.spread, record.spread_floats, &out->spread);
}

bool is_used_up(const LevelView& rest) noexcept {
  return rest.regions.empty() && rest.nodes.empty() && rest.graph_rows.empty() &&
         rest.graph_columns.empty() && rest.graph_values.empty() && rest.carry.empty() &&
         rest.region_modes.empty() && rest.mode_matrices.empty() && rest.picks.empty() && rest.spread.empty();
}

// ---- a coarser level against the next finer one ----

Status check_same_regions(const LevelView& fine, const LevelView& coarse, uint32_t level) noexcept {
  for (size_t r = 0; r < fine.regions.size(); ++r) {
    const RegionRecord &of = fine.regions[r], &region = coarse.regions[r];
    const RegionModesRecord &modes_of = fine.region_modes[r], &modes = coarse.region_modes[r];
    if (region.first_vertex != of.first_vertex || region.vertex_count != of.vertex_count)
      return corrupt("LOD %u: region %zu moves other vertices than in the finer LOD", level, r);
    if (region.touches_body != of.touches_body)
      return corrupt("LOD %u: region %zu touches other things than in the finer LOD", level, r);
    if (modes.first_mode != modes_of.first_mode || modes.mode_count != modes_of.mode_count)
      return corrupt("LOD %u: region %zu has other modes than in the finer LOD", level, r);
  }
  return {};
}

bool is_same_place(const NodeRecord& a, const NodeRecord& b) noexcept {
  return std::ranges::equal(a.position_m, b.position_m);
}

Status check_picks(const LevelView& fine, const LevelView& coarse, uint32_t level) noexcept {
  for (size_t n = 0; n < coarse.nodes.size(); ++n) {
    const uint32_t pick = coarse.picks[n];
    if (pick >= fine.nodes.size() || (n > 0 && pick <= coarse.picks[n - 1]))
      return corrupt("LOD %u: node %zu is node %u of the finer LOD: not there, or not ascending", level, n,
                     pick);
    if (fine.nodes[pick].region != coarse.nodes[n].region ||
        !is_same_place(fine.nodes[pick], coarse.nodes[n]))
      return corrupt("LOD %u: node %zu is not where node %u of the finer LOD is", level, n, pick);
  }
  return {};
}

Status check_held_alike(const LevelView& fine, const LevelView& coarse, uint32_t level) noexcept {
  for (size_t r = 0; r < fine.regions.size(); ++r) {
    const RegionRecord &of = fine.regions[r], &region = coarse.regions[r];
    if (region.node_count == 0) continue;
    if (coarse.picks[region.first_node + region.anchor_node] != of.first_node + of.anchor_node)
      return corrupt("LOD %u: region %zu is held elsewhere than in the finer LOD", level, r);
  }
  return {};
}

Status check_spread(const LevelView& fine, const LevelView& coarse, uint32_t level) noexcept {
  std::span<const float> rest = coarse.spread;
  for (size_t r = 0; r < fine.regions.size(); ++r) {
    const uint64_t used = fine.regions[r].node_count, padded = round_up_16(used);
    for (uint32_t n = 0; n < coarse.regions[r].node_count; ++n) {
      std::span<const float> row;
      if (!take(rest, padded, &row)) return corrupt("LOD %u: spread ends early", level);
      if (!are_within(row, kMostSpread))
        return corrupt("LOD %u: a weight of spread is not within +-100", level);
      if (std::ranges::any_of(row.subspan(used), [](float v) { return v != 0; }))
        return corrupt("LOD %u: padding of spread is not zero", level);
    }
  }
  return rest.empty() ? Status{} : corrupt("LOD %u: spread that no region owns", level);
}

Status check_coarser(const PackView& pack, uint32_t level) noexcept {
  using CheckLevel = Status (*)(const LevelView&, const LevelView&, uint32_t) noexcept;
  constexpr CheckLevel kChecks[] = {check_same_regions, check_picks, check_held_alike, check_spread};
  for (const CheckLevel check : kChecks) {
    const Status status = check(pack.levels[level - 1], pack.levels[level], level);
    if (!status.ok()) return status;
  }
  return {};
}

}  // namespace

Status cut_levels(PackView* pack) noexcept {
  pack->levels[0] = *pack;
  const uint32_t coarser = pack->character != nullptr ? pack->character->coarser_count : 0;
  if (coarser >= kMostGraphLevels) return corrupt("the character has %u coarser LODs, outside 0..3", coarser);
  if (pack->level_records.size() != (coarser > 0 ? coarser + 1 : 0))
    return corrupt("LODs: %zu records for %u coarser ones", pack->level_records.size(), coarser);
  if (coarser == 0) {
    const bool none = pack->picks.empty() && pack->spread.empty();
    return none ? Status{} : corrupt("picks or spread without a coarser LOD");
  }
  LevelView rest = *pack, cut[kMostGraphLevels];
  for (uint32_t level = 0; level <= coarser; ++level)
    if (!take_level(*pack, level, rest, &cut[level])) return corrupt("LOD %u: a section ends early", level);
  if (!is_used_up(rest)) return corrupt("LODs: a section holds more than they state");
  std::ranges::copy(cut, pack->levels);
  static_cast<LevelView&>(*pack) = cut[0];
  pack->level_count = coarser + 1;
  return {};
}

// A coarser level may leave regions out, but not all; the finest none.
Status check_nodes_of(const PackView& pack, uint32_t level) noexcept {
  const LevelView& of = pack.levels[level];
  for (size_t r = 0; r < of.regions.size(); ++r)
    if (level == 0 && of.regions[r].node_count == 0)
      return corrupt("region %zu: 0 nodes, outside 1..4096", r);
  if (level > 0 && of.nodes.empty() && !of.regions.empty()) return corrupt("LOD %u: it has no nodes", level);
  return {};
}

Status check_levels(const PackView& pack) noexcept {
  constexpr Check kChecks[] = {check_tissue, check_modes};
  for (uint32_t level = 0; level < pack.level_count; ++level) {
    if (Status status = check_nodes_of(pack, level); !status.ok()) return status;
    if (Status status = run_checks(kChecks, at_level(pack, level)); !status.ok()) return status;
    if (level == 0) continue;
    if (Status status = check_coarser(pack, level); !status.ok()) return status;
  }
  return {};
}

}  // namespace sinew::pack
