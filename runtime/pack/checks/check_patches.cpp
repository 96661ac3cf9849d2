// check_patches.cpp  Regions whose patches a network predicts have it, and all that it is told of their
// nodes.
#include <algorithm>
#include <cmath>

#include "core/status.hpp"
#include "pack/checks/checks.hpp"

namespace sinew::pack {
namespace {

constexpr float kMostMaterial = 50;  // logarithms, and masses in full cells

Status check_nothing(const PackView& pack) noexcept {
  const ChainsView& chains = pack.patch_network;
  const bool empty = !chains.record && chains.layers.empty() && chains.weights.empty() &&
                     pack.patch_material.empty() && pack.patch_held.empty();
  return empty ? Status{} : corrupt("patches: a network or material for regions that are not there");
}

Status check_emulator(const PackView& pack) noexcept {
  const ChainsView& chains = pack.patch_network;
  if (!chains.record) return corrupt("patches: no network for regions that want one");
  if (chains.record->model != ModelKind::kDeepEmulator || chains.record->moving != 1)
    return core::make_status(StatusCode::kUnsupported,
                             "pack: patches' network of model %u, moving %u; bake it with weights of a "
                             "deep_emulator of metadata frame 'going_on'",
                             static_cast<uint32_t>(chains.record->model), chains.record->moving);
  if (Status status = check_chains(chains); !status.ok()) return status;
  if (chains.record->rate_hz != pack.network->rate_hz)
    return corrupt("patches: a network of %g ticks a second, the character has %g",
                   double{chains.record->rate_hz}, double{pack.network->rate_hz});
  return {};
}

Status check_region(const PackView& pack, size_t r) noexcept {
  const RegionRecord& region = pack.regions[r];
  if (region.cell_m == 0) return {};
  const auto held = pack.patch_held.subspan(region.first_node, region.node_count);
  if (std::ranges::count(held, uint8_t{0}) == 0) return corrupt("region %zu: none of its nodes is free", r);
  if (std::ranges::count(held, uint8_t{1}) == 0) return corrupt("region %zu: none of its nodes is held", r);
  return {};
}

}  // namespace

Status check_patches(const PackView& pack) noexcept {
  bool any = false;
  for (size_t r = 0; r < pack.regions.size(); ++r) {
    const float cell_m = pack.regions[r].cell_m;
    if (cell_m != 0 && !is_within(cell_m, kLeastSize_m, kFarthest_m))
      return corrupt("region %zu: cells of %g m", r, double{cell_m});
    any |= cell_m > 0;
  }
  for (uint32_t level = 1; level < pack.level_count; ++level)
    for (size_t r = 0; r < pack.levels[level].regions.size(); ++r)
      if (pack.levels[level].regions[r].cell_m != 0)
        return corrupt("region %zu: cells in a coarser control graph", r);
  if (!any) return check_nothing(pack);
  if (pack.level_count != 1) return corrupt("patches: coarser control graphs in addition to their regions");
  if (Status status = check_emulator(pack); !status.ok()) return status;
  const size_t nodes = pack.nodes.size();
  if (pack.patch_material.size() != 3 * nodes || pack.patch_held.size() != nodes)
    return corrupt("patches: material of %zu numbers and %zu marks for %zu nodes", pack.patch_material.size(),
                   pack.patch_held.size(), nodes);
  if (Status status = check_within(pack.patch_material, kMostMaterial, "patch material"); !status.ok())
    return status;
  if (std::ranges::any_of(pack.patch_held, [](uint8_t held) { return held > 1; }))
    return corrupt("patches: a mark of a held node is neither 0 nor 1");
  for (size_t r = 0; r < pack.regions.size(); ++r)
    if (Status status = check_region(pack, r); !status.ok()) return status;
  return {};
}

}  // namespace sinew::pack
