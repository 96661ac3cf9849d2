// pack_view.hpp  What a pack holds, as views of its bytes.
#pragma once
#include <cstddef>
#include <span>

#include "pack/format.hpp"

namespace sinew::pack {

// What of a character's tissue belongs to one control graph (LevelRecord).
struct LevelView {
  std::span<const RegionRecord> regions;
  std::span<const NodeRecord> nodes;
  std::span<const uint32_t> graph_rows, graph_columns;
  std::span<const float> graph_values;
  std::span<const float> carry;
  std::span<const RegionModesRecord> region_modes;
  std::span<const float> mode_matrices;
  std::span<const uint32_t> picks;  // a node; of the finest none, as the next
  std::span<const float> spread;
};

// A network of chains of dense layers.
struct ChainsView {
  const NetworkRecord* record = nullptr;  // null: none
  std::span<const DenseRecord> layers;
  std::span<const float> weights;
};

// Of the levels, the one in view has its parts here: the finest, as it is opened.
struct PackView : LevelView {
  FileKind kind{};
  std::span<const char> strings, metadata;
  const NetworkRecord* network = nullptr;
  std::span<const LayerRecord> layers;
  std::span<const InputRecord> inputs;
  std::span<const float> weights;
  std::span<const int8_t> int8_weights;  // empty but in an int8 model, as the next two; not looked into
  std::span<const int32_t> int8_sums;
  std::span<const float> int8_scales;
  std::span<const DenseRecord> dense;  // of a network of chains, which has no layers
  // Character packs only; empty in a model.
  const CharacterRecord* character = nullptr;
  std::span<const JointRecord> joints;
  std::span<const float> positions, normals;  // 3 a vertex
  std::span<const uint32_t> triangles;        // 3 a triangle
  std::span<const SkinRecord> skin;
  std::span<const uint8_t> colors;  // 4 a vertex
  std::span<const uint32_t> welded;
  std::span<const float> face_normals;  // 3 a vertex
  std::span<const MeshRecord> meshes;
  std::span<const PrimitiveRecord> primitives;
  std::span<const float> tangents;  // 4 a vertex; empty where the file tells none
  std::span<const uint32_t> region_vertices;
  std::span<const ModeRecord> modes;
  std::span<const ClipRecord> clips;
  std::span<const float> clip_frames;  // 12 a joint and frame
  std::span<const TierRecord> tiers;
  std::span<const RodRecord> rods;
  std::span<const RodSegmentRecord> rod_segments;
  std::span<const ProxyRecord> proxies;
  std::span<const uint32_t> joint_rods;  // a joint; empty without rods
  ChainsView rod_network;
  ChainsView patch_network;
  std::span<const float> patch_material;  // 3 a node of the finest level; empty without a patch network
  std::span<const uint8_t> patch_held;
  std::span<const LevelRecord> level_records;  // empty where there is one level
  LevelView levels[kMostGraphLevels];          // finest first
  uint32_t level_count = 1;
};

// The same pack with another level in view; level < level_count.
PackView at_level(const PackView& pack, uint32_t level) noexcept;

inline bool has_network(const PackView& pack) noexcept { return pack.network->model != ModelKind::kNone; }
inline bool emulates_patches(const PackView& pack) noexcept { return pack.patch_network.record != nullptr; }
// Either makes the tier.
inline bool affords_network(const PackView& pack) noexcept {
  return has_network(pack) || emulates_patches(pack);
}

const char* string_at(const PackView& pack, uint32_t offset) noexcept;

}  // namespace sinew::pack
