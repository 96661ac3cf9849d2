// asset.cpp  A loaded character: checked views of its pack.
#include "world/asset.hpp"

#include <cstring>

#include "core/status.hpp"
#include "world/instance.hpp"

namespace sinew::world {
namespace {

using core::make_status;

float baked_cost_us(const pack::PackView& pack, Tier tier) noexcept {
  for (const pack::TierRecord& record : pack.tiers) {
    if (record.tier == static_cast<uint32_t>(tier)) return record.cost_us;
  }
  return -1;
}

// Of one tick where the pack says nothing: multiplications at a rate any processor of the last ten years
// reaches.
float counted_cost_us(const Asset& asset) noexcept {
  constexpr double kFlopPerMicrosecond = 10e3, kGates = 4, kPeepholes = 3;
  double multiplications = 0;
  for (const pack::LayerRecord& layer : asset.network.layers) {
    const double rows =
        kGates * (layer.inputs * (layer.has_self ? 2.0 : 1.0) + layer.channels) + kPeepholes * layer.channels;
    multiplications += asset.node_count() * rows * layer.padded;
  }
  return static_cast<float>(2 * multiplications / kFlopPerMicrosecond);
}

frame::CostModel baked_costs(const Asset& asset) noexcept {
  const float tick_us = baked_cost_us(asset.pack, Tier::kNetwork);
  const float base_us = baked_cost_us(asset.pack, Tier::kSkinning);
  return {.tick = frame::CostEstimate(tick_us > 0 ? tick_us : counted_cost_us(asset)),
          .base = frame::CostEstimate(base_us > 0 ? base_us : 0)};
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
  if (pack.inputs.empty()) {
    return make_status(StatusCode::kUnsupported,
                       "asset: the network lists no inputs (the paper's wiring), which only sinew-bake check "
                       "runs; train with inputs");
  }
  return {};
}

}  // namespace

Status open_asset(std::span<const std::byte> bytes, Asset* out) noexcept {
  pack::PackView view;
  if (Status status = pack::open_pack(bytes, &view); !status.ok()) return status;
  if (Status status = check_runnable(view); !status.ok()) return status;
  Asset& asset = *out;
  asset.pack = view;
  asset.network = {view.network, view.layers, view.inputs, view.weights.data()};
  asset.graph = {view.character->node_count, view.graph_rows.data(), view.graph_columns.data(),
                 view.graph_values.data()};
  asset.tick_s = 1 / static_cast<double>(view.network->rate_hz);
  asset.fingerprint = fingerprint_of(bytes);
  asset.padded_vertices = 0;
  for (const pack::RegionRecord& region : view.regions) asset.padded_vertices += region.padded_vertices;
  asset.cost = baked_costs(asset);
  return {};
}

AssetInfo describe(const Asset& asset) noexcept {
  const pack::CharacterRecord& character = *asset.pack.character;
  return {.vertex_count = character.vertex_count,
          .triangle_count = character.triangle_count,
          .joint_count = character.joint_count,
          .region_count = character.region_count,
          .node_count = character.node_count,
          .clip_count = character.clip_count,
          .tick_hz = asset.pack.network->rate_hz,
          .height_m = character.height_m,
          .instance_bytes = instance_bytes(asset)};
}

}  // namespace sinew::world
