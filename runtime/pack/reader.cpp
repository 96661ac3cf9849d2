// reader.cpp  Bytes to checked views.
#include "pack/reader.hpp"

#include "pack/checks.hpp"
#include "pack/section_table.hpp"

namespace sinew::pack {
namespace {

template <class T>
const T* only(std::span<const T> records) noexcept {
  return records.size() == 1 ? records.data() : nullptr;
}

PackView view_sections(const SectionTable& table) noexcept {
  using enum SectionKind;
  return {.kind = table.kind,
          .strings = table.get<char>(kStrings),
          .metadata = table.get<char>(kMetadata),
          .network = only(table.get<NetworkRecord>(kNetwork)),
          .layers = table.get<LayerRecord>(kLayers),
          .inputs = table.get<InputRecord>(kInputs),
          .weights = table.get<float>(kWeights),
          .int8_weights = table.get<int8_t>(kInt8Weights),
          .int8_sums = table.get<int32_t>(kInt8Sums),
          .int8_scales = table.get<float>(kInt8Scales),
          .dense = table.get<DenseRecord>(kDense),
          .character = only(table.get<CharacterRecord>(kCharacter)),
          .joints = table.get<JointRecord>(kJoints),
          .positions = table.get<float>(kPositions),
          .normals = table.get<float>(kNormals),
          .triangles = table.get<uint32_t>(kTriangles),
          .skin = table.get<SkinRecord>(kSkin),
          .colors = table.get<uint8_t>(kColors),
          .welded = table.get<uint32_t>(kWelded),
          .regions = table.get<RegionRecord>(kRegions),
          .nodes = table.get<NodeRecord>(kNodes),
          .graph_rows = table.get<uint32_t>(kGraphRows),
          .graph_columns = table.get<uint32_t>(kGraphColumns),
          .graph_values = table.get<float>(kGraphValues),
          .region_vertices = table.get<uint32_t>(kRegionVertices),
          .carry = table.get<float>(kCarry),
          .region_modes = table.get<RegionModesRecord>(kRegionModes),
          .modes = table.get<ModeRecord>(kModes),
          .mode_matrices = table.get<float>(kModeMatrices),
          .compliance = table.get<float>(kCompliance),
          .springs = table.get<SpringRecord>(kSprings),
          .clips = table.get<ClipRecord>(kClips),
          .clip_frames = table.get<float>(kClipFrames),
          .tiers = table.get<TierRecord>(kTiers),
          .rods = table.get<RodRecord>(kRods),
          .rod_segments = table.get<RodSegmentRecord>(kRodSegments),
          .proxies = table.get<ProxyRecord>(kProxies),
          .joint_rods = table.get<uint32_t>(kJointRods)};
}

Status check_strings(const PackView& pack) noexcept {
  return pack.strings.empty() || pack.strings.back() == '\0' ? Status{}
                                                             : corrupt("strings: the last one does not end");
}

}  // namespace

Status open_pack(std::span<const std::byte> bytes, PackView* out) noexcept {
  SectionTable table;
  if (Status status = read_section_table(bytes, &table); !status.ok()) return status;
  const PackView view = view_sections(table);
  constexpr Check kModelChecks[] = {check_strings, check_network};
  constexpr Check kCharacterChecks[] = {check_strings, check_network, check_character, check_tissue,
                                        check_modes,   check_rods,    check_proxies};
  const bool is_model = view.kind == FileKind::kModel;
  const std::span<const Check> checks = is_model ? std::span<const Check>(kModelChecks) : kCharacterChecks;
  if (Status status = run_checks(checks, view); !status.ok()) return status;
  *out = view;
  return {};
}

const char* string_at(const PackView& pack, uint32_t offset) noexcept {
  return offset < pack.strings.size() ? pack.strings.data() + offset : "";
}

}  // namespace sinew::pack
