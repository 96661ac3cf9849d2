// reader.cpp  Bytes to checked views.
#include "pack/reader.hpp"

#include "pack/checks/checks.hpp"
#include "pack/section_table.hpp"

namespace sinew::pack {
namespace {

template <class T>
const T* only(std::span<const T> records) noexcept {
  return records.size() == 1 ? records.data() : nullptr;
}

LevelView view_tissue(const SectionTable& table) noexcept {
  using enum SectionKind;
  return {.regions = table.get<RegionRecord>(kRegions),
          .nodes = table.get<NodeRecord>(kNodes),
          .graph_rows = table.get<uint32_t>(kGraphRows),
          .graph_columns = table.get<uint32_t>(kGraphColumns),
          .graph_values = table.get<float>(kGraphValues),
          .carry = table.get<float>(kCarry),
          .region_modes = table.get<RegionModesRecord>(kRegionModes),
          .mode_matrices = table.get<float>(kModeMatrices),
          .picks = table.get<uint32_t>(kPicks),
          .spread = table.get<float>(kSpread)};
}

// All levels' parts in view.
PackView view_sections(const SectionTable& table) noexcept {
  using enum SectionKind;
  PackView view;
  static_cast<LevelView&>(view) = view_tissue(table);
  view.kind = table.kind;
  view.strings = table.get<char>(kStrings);
  view.metadata = table.get<char>(kMetadata);
  view.network = only(table.get<NetworkRecord>(kNetwork));
  view.layers = table.get<LayerRecord>(kLayers);
  view.inputs = table.get<InputRecord>(kInputs);
  view.weights = table.get<float>(kWeights);
  view.int8_weights = table.get<int8_t>(kInt8Weights);
  view.int8_sums = table.get<int32_t>(kInt8Sums);
  view.int8_scales = table.get<float>(kInt8Scales);
  view.dense = table.get<DenseRecord>(kDense);
  view.character = only(table.get<CharacterRecord>(kCharacter));
  view.joints = table.get<JointRecord>(kJoints);
  view.positions = table.get<float>(kPositions);
  view.normals = table.get<float>(kNormals);
  view.triangles = table.get<uint32_t>(kTriangles);
  view.skin = table.get<SkinRecord>(kSkin);
  view.colors = table.get<uint8_t>(kColors);
  view.welded = table.get<uint32_t>(kWelded);
  view.face_normals = table.get<float>(kFaceNormals);
  view.meshes = table.get<MeshRecord>(kMeshes);
  view.primitives = table.get<PrimitiveRecord>(kPrimitives);
  view.tangents = table.get<float>(kTangents);
  view.region_vertices = table.get<uint32_t>(kRegionVertices);
  view.modes = table.get<ModeRecord>(kModes);
  view.clips = table.get<ClipRecord>(kClips);
  view.clip_frames = table.get<float>(kClipFrames);
  view.tiers = table.get<TierRecord>(kTiers);
  view.rods = table.get<RodRecord>(kRods);
  view.rod_segments = table.get<RodSegmentRecord>(kRodSegments);
  view.proxies = table.get<ProxyRecord>(kProxies);
  view.joint_rods = table.get<uint32_t>(kJointRods);
  view.rod_network = {only(table.get<NetworkRecord>(kRodNetwork)), table.get<DenseRecord>(kRodDense),
                      table.get<float>(kRodWeights)};
  view.patch_network = {only(table.get<NetworkRecord>(kPatchNetwork)), table.get<DenseRecord>(kPatchDense),
                        table.get<float>(kPatchWeights)};
  view.patch_material = table.get<float>(kPatchMaterial);
  view.patch_held = table.get<uint8_t>(kPatchHeld);
  view.level_records = table.get<LevelRecord>(kLevels);
  return view;
}

// A kind of which there is one record at most.
Status check_single(const SectionTable& table) noexcept {
  for (const auto& [kind, name] : {std::pair{SectionKind::kRodNetwork, "rod network"},
                                   std::pair{SectionKind::kPatchNetwork, "patch network"}}) {
    const size_t count = table.get<NetworkRecord>(kind).size();
    if (count > 1) return corrupt("%s: %zu records", name, count);
  }
  return {};
}

Status check_strings(const PackView& pack) noexcept {
  return pack.strings.empty() || pack.strings.back() == '\0' ? Status{}
                                                             : corrupt("strings: the last one does not end");
}

}  // namespace

Status open_pack(std::span<const std::byte> bytes, PackView* out) noexcept {
  SectionTable table;
  if (Status status = read_section_table(bytes, &table); !status.ok()) return status;
  if (Status status = check_single(table); !status.ok()) return status;
  PackView view = view_sections(table);
  constexpr Check kModelChecks[] = {check_strings, check_network};
  constexpr Check kCharacterChecks[] = {check_strings, check_network, check_character, check_primitives,
                                        check_levels,  check_patches, check_rods,      check_proxies};
  const bool is_model = view.kind == FileKind::kModel;
  if (!is_model)
    if (Status status = cut_levels(&view); !status.ok()) return status;
  const std::span<const Check> checks = is_model ? std::span<const Check>(kModelChecks) : kCharacterChecks;
  if (Status status = run_checks(checks, view); !status.ok()) return status;
  *out = view;
  return {};
}

PackView at_level(const PackView& pack, uint32_t level) noexcept {
  PackView view = pack;
  static_cast<LevelView&>(view) = pack.levels[level];
  return view;
}

const char* string_at(const PackView& pack, uint32_t offset) noexcept {
  return offset < pack.strings.size() ? pack.strings.data() + offset : "";
}

}  // namespace sinew::pack
