// open_asset.cpp  From a pack's bytes to an asset: checks, views, tables that its instances share.
#include "character/asset/open_asset.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <utility>

#include "character/asset/affords_surface.hpp"
#include "character/asset/rod_batches.hpp"
#include "character/contacts/own_body_touches.hpp"
#include "character/motion/pose_bound.hpp"
#include "core/status.hpp"
#include "pack/reader.hpp"
#include "tissue/network/narrow_layer.hpp"

namespace sinew::world {
namespace {

using core::make_status;

// Errors of a network that was not judged are not known in millimetres: a usual share of the height then.
constexpr float kUsualSkinningError = 5e-3f;
// Tiers on which skins are touched were baked without, and skins may be most of what they cost: one that
// proved too dear is believed soon, and tried again after some ten seconds instead of one.
constexpr frame::CostEstimate::Correction kWithSurface{.drift = 1e-3f, .rise = 0.5f};

// What was not measured on a coarser graph follows from what was on the finest.
float measured_error(const pack::PackView& pack, const pack::TierRecord& record) noexcept {
  if (!std::isnan(record.error_ratio)) return record.error_ratio;
  float finest = frame::usual_error(static_cast<Tier>(record.tier));
  for (const pack::TierRecord& other : pack.tiers) {
    const bool same = other.tier == record.tier && other.level == 0;
    if (same && !std::isnan(other.error_ratio)) finest = other.error_ratio;
  }
  return frame::coarser_error(finest, record.level);
}

// A recipe that has parts emulated chose their network, wherever the budget affords it: it counts as better
// than skinning, and modes, which may be nearer to the truth, as worse than it.
float told_error(const pack::PackView& pack, const pack::TierRecord& record) noexcept {
  constexpr float kMostOfNetwork = 0.94f, kMostOfModes = 0.99f, kChosen = 1.05f;
  const auto network = static_cast<uint32_t>(Tier::kNetwork);
  const float error = measured_error(pack, record);
  if (!emulates_patches(pack) || !frame::is_simulated(static_cast<Tier>(record.tier))) return error;
  if (record.tier == network) return std::min(error, kMostOfNetwork);
  float chosen = frame::usual_error(Tier::kNetwork);
  for (const pack::TierRecord& other : pack.tiers)
    if (other.tier == network) chosen = std::min(measured_error(pack, other), kMostOfNetwork);
  return std::clamp(error, kChosen * chosen, std::max(kMostOfModes, error));
}

void read_point(const pack::PackView& pack, const pack::TierRecord& record, Asset& asset) noexcept {
  const auto tier = static_cast<Tier>(record.tier);
  if (!frame::is_simulated(tier) || asset.point_count == frame::kMostLevels) return;
  asset.points[asset.point_count++] = {tier, record.cost_us, told_error(pack, record), record.level};
  asset.costs.cost.of(tier, record.level) = frame::CostEstimate(record.cost_us);
  asset.surface_costs.cost.of(tier, record.level) = affords_surface(tier, record.level)
                                                        ? frame::CostEstimate(record.cost_us, kWithSurface)
                                                        : frame::CostEstimate(record.cost_us);
}

void read_tiers(const pack::PackView& pack, Asset& asset) noexcept {
  asset.point_count = 0;
  asset.skinning_mm = kUsualSkinningError * 1e3f * pack.character->height_m;
  for (const pack::TierRecord& record : pack.tiers) {
    read_point(pack, record, asset);
    if (record.tier == static_cast<uint32_t>(Tier::kExtrapolate))
      asset.costs.cost.publish = asset.surface_costs.cost.publish = frame::CostEstimate(record.cost_us);
    if (record.tier != static_cast<uint32_t>(Tier::kSkinning)) continue;
    asset.idle_us = record.cost_us;
    if (record.error_mm > 0) asset.skinning_mm = record.error_mm;
  }
  frame::make_front({asset.points, asset.point_count}, asset.idle_us, &asset.costs.front);
  make_modal_front({asset.points, asset.point_count}, asset.idle_us, &asset.costs);
  asset.surface_costs.front = asset.costs.front;
  asset.surface_costs.modal_front = asset.costs.modal_front;
  // The first tick on a finer graph is the first on skin, too: what it takes more is not to be kept for ever.
  asset.surface_costs.cost.change = frame::CostEstimate(0);
}

// The section table holds every section's checksum, so its own checksum stands for the whole file.
uint64_t fingerprint_of(std::span<const std::byte> bytes) noexcept {
  pack::FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  return header.table_checksum;
}

Status check_runnable(const pack::PackView& pack) noexcept {
  if (pack.kind != pack::FileKind::kCharacter) {
    return make_status(StatusCode::kUnsupported,
                       "asset: this pack is a model without a character; bake one with sinew-bake character");
  }
  return {};
}

Status pack_narrow_layers(const pack::PackView& pack, core::AlignedBlock* out) noexcept {
  const tissue::Network network{pack.network, pack.layers, pack.inputs, pack.weights.data()};
  core::AlignedBlock packed(tissue::narrow_floats(network) * sizeof(float));
  if (!packed.data()) return make_status(StatusCode::kOutOfCapacity, "asset: no memory for its network");
  tissue::pack_narrow(network, reinterpret_cast<float*>(packed.data()));
  *out = std::move(packed);
  return {};
}

float largest_extent_m(const pack::PackView& pack) noexcept {
  Eigen::AlignedBox3f box;
  for (size_t at = 0; at < pack.positions.size(); at += 3)
    box.extend(Eigen::Map<const Eigen::Vector3f>(&pack.positions[at]));
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

// What no instance could be made of is refused with the asset.
Status check_rods(const Asset& asset) noexcept {
  std::unique_ptr<rods::RodBatch[]> unused;
  const Status status = make_rod_batches(asset, {}, &unused);
  if (status.ok() || status.code == StatusCode::kOutOfCapacity) return status;
  return make_status(StatusCode::kCorrupt, "asset: its rods cannot be stepped, bake it again: %.300s",
                     status.message);
}

void measure_level(const pack::PackView& pack, Asset& asset) noexcept {
  for (const pack::RegionModesRecord& modes : pack.region_modes) {
    const uint32_t floats = modes.padded + static_cast<uint32_t>(pack::round_up_16(modes.mode_count));
    asset.widest_region = std::max(asset.widest_region, floats);
  }
}

Status find_slopes(GraphLevel& level) noexcept {
  const size_t count = level.pack.modes.size() + level.pack.region_modes.size();
  level.swing_slopes.reset(new (std::nothrow) tissue::SwingSlopes[count]);
  if (!level.swing_slopes) return make_status(StatusCode::kOutOfCapacity, "asset: no memory for its modes");
  for (size_t r = 0; r < level.pack.region_modes.size(); ++r) {
    const pack::RegionModesRecord& record = level.pack.region_modes[r];
    tissue::SwingSlopes* out = level.swing_slopes.get() + record.first_mode + r;
    for (const pack::ModeRecord& mode : level.pack.modes.subspan(record.first_mode, record.mode_count))
      *out++ = tissue::swing_slopes(mode.a1, mode.a2);
    *out = tissue::swing_slopes(record.rest_a1, record.rest_a2);
  }
  return {};
}

Status read_levels(const pack::PackView& pack, Asset& asset) noexcept {
  asset.level_count = pack.level_count;
  asset.widest_region = 0;
  for (uint32_t l = 0; l < pack.level_count; ++l) {
    GraphLevel& level = asset.levels[l];
    level.pack = pack::at_level(pack, l);
    level.graph = {level.node_count(), level.pack.graph_rows.data(), level.pack.graph_columns.data(),
                   level.pack.graph_values.data()};
    if (Status status = find_slopes(level); !status.ok()) return status;
    measure_level(level.pack, asset);
  }
  asset.padded_vertices = 0;  // the same at all levels
  for (const pack::RegionRecord& region : pack.regions) asset.padded_vertices += region.padded_vertices;
  return {};
}

}  // namespace

Status open_asset(std::span<const std::byte> bytes, Asset* out) noexcept {
  pack::PackView view;
  if (Status status = pack::open_pack(bytes, &view); !status.ok()) return status;
  if (Status status = check_runnable(view); !status.ok()) return status;
  RodRig rods;
  if (Status status = make_rod_rig(view, &rods); !status.ok()) return status;
  std::unique_ptr<uint64_t[]> touchable;
  if (Status status = find_touchable(view, &touchable); !status.ok()) return status;
  core::AlignedBlock narrow;
  if (Status status = pack_narrow_layers(view, &narrow); !status.ok()) return status;
  Asset asset;
  asset.pack = view;
  asset.touchable = std::move(touchable);
  asset.rods = std::move(rods);
  asset.rod_network = {view.rod_network.record, view.rod_network.layers, view.rod_network.weights.data()};
  asset.emulator = {view.patch_network.layers, view.patch_network.weights.data()};
  asset.network = {view.network, view.layers, view.inputs, view.weights.data()};
  asset.narrow = std::move(narrow);
  asset.network.narrow = reinterpret_cast<const float*>(asset.narrow.data());
  asset.tick_s = 1 / static_cast<double>(view.network->rate_hz);
  asset.fingerprint = fingerprint_of(bytes);
  if (Status status = read_levels(view, asset); !status.ok()) return status;
  if (Status status = find_soft_vertices(view, &asset.soft); !status.ok()) return status;
  if (Status status = check_rods(asset); !status.ok()) return status;
  read_tiers(view, asset);
  asset.extent_m = largest_extent_m(view);
  if (Status status = measure_reach(asset, &asset.reach_m); !status.ok()) return status;
  *out = std::move(asset);
  return {};
}

}  // namespace sinew::world
