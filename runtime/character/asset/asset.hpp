// asset.hpp  A loaded character: checked views of its pack, shared by its instances.
#pragma once
#include <cstddef>
#include <memory>
#include <span>

#include "character/asset/graph_level.hpp"
#include "character/asset/rod_rig.hpp"
#include "character/asset/soft_vertices.hpp"
#include "core/aligned_block.hpp"
#include "pack/mapped_file.hpp"
#include "rods/start/coping_net.hpp"
#include "schedule/cost_model.hpp"
#include "schedule/front.hpp"
#include "sinew/types.hpp"
#include "tissue/network/deep_emulator.hpp"

namespace sinew::world {

// What tiers cost, and which of them are worth buying.
struct TierCosts {
  frame::CostModel cost;
  frame::Front front;  // of the asset's points, at what they cost now (world/step/plan.hpp)
  // Of those without the network's; kept up once an instance was limited to them (character/tier_limit.hpp).
  frame::Front modal_front;
  bool limited = false;
};

void make_modal_front(std::span<const frame::Level> points, float publish_us, TierCosts* out) noexcept;

struct Asset {
  pack::MappedFile file;      // empty when the caller keeps the bytes
  pack::PackView pack;        // the finest level in view
  tissue::Network network;    // without layers where the character has none
  core::AlignedBlock narrow;  // its narrow layers' weights
  GraphLevel levels[pack::kMostGraphLevels];
  uint32_t level_count = 1;
  RodRig rods;
  rods::CopingNet rod_network;    // without a record where the pack has none
  tissue::DeepEmulator emulator;  // without layers where the pack has none
  std::unique_ptr<uint64_t[]>
      touchable;  // [regions]: character/contacts/own_body_touches.hpp; null: none for any
  double tick_s = 0;
  uint64_t fingerprint = 0;  // of all of the pack's bytes
  SoftVertices soft;
  uint32_t padded_vertices = 0;  // carried vertices of all regions, each region padded
  // Of the level that takes the most:
  uint32_t widest_region = 0;  // floats of its nodes' x y z and of its modes, each padded
  float reach_m = 0;           // character/motion/pose_bound.hpp
  float extent_m = 0;          // of the bind pose along x, y or z, the largest
  uint32_t live_instances = 0, surface_instances = 0;  // the latter with ContactDef::surface
  TierCosts costs, surface_costs;                      // the latter of instances with ContactDef::surface
  frame::Level points[frame::kMostLevels];             // as baked
  uint32_t point_count = 0;
  float skinning_mm = 1;  // skinning's error
  float idle_us = 0;      // baked: a step, of what is neither simulated nor displaced

  uint32_t node_count() const noexcept { return pack.character->node_count; }  // of the finest level
  uint32_t mode_count() const noexcept { return static_cast<uint32_t>(pack.modes.size()); }
  bool emulates() const noexcept { return pack::emulates_patches(pack); }
  Tier best() const noexcept { return pack::affords_network(pack) ? Tier::kNetwork : Tier::kModal; }
  uint32_t vertex_count() const noexcept { return pack.character->vertex_count; }
};

// A tier's baked error, a share of skinning's; 1 of what is not simulated.
float error_of(const Asset& asset, Tier tier, uint32_t level) noexcept;

}  // namespace sinew::world
