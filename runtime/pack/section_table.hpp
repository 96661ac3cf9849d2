// section_table.hpp  The outer shell of a pack: header, section table, checksums. Nothing inside a section is
// looked at.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "pack/format.hpp"
#include "sinew/status.hpp"

namespace sinew::pack {

struct SectionRule {
  SectionKind kind;
  uint32_t element_bytes;
  const char* name;
};

// Every kind this version knows, ascending.
inline constexpr SectionRule kSectionRules[] = {
    {SectionKind::kStrings, 1, "strings"},
    {SectionKind::kMetadata, 1, "metadata"},
    {SectionKind::kNetwork, sizeof(NetworkRecord), "network"},
    {SectionKind::kLayers, sizeof(LayerRecord), "layers"},
    {SectionKind::kInputs, sizeof(InputRecord), "inputs"},
    {SectionKind::kWeights, sizeof(float), "weights"},
    {SectionKind::kInt8Weights, 1, "int8 weights"},
    {SectionKind::kInt8Sums, sizeof(int32_t), "int8 sums"},
    {SectionKind::kInt8Scales, sizeof(float), "int8 scales"},
    {SectionKind::kDense, sizeof(DenseRecord), "dense layers"},
    {SectionKind::kCharacter, sizeof(CharacterRecord), "character"},
    {SectionKind::kJoints, sizeof(JointRecord), "joints"},
    {SectionKind::kPositions, 3 * sizeof(float), "positions"},
    {SectionKind::kNormals, 3 * sizeof(float), "normals"},
    {SectionKind::kTriangles, 3 * sizeof(uint32_t), "triangles"},
    {SectionKind::kSkin, sizeof(SkinRecord), "skin"},
    {SectionKind::kColors, 4, "colors"},
    {SectionKind::kWelded, sizeof(uint32_t), "welded"},
    {SectionKind::kFaceNormals, 3 * sizeof(float), "face normals"},
    {SectionKind::kMeshes, sizeof(MeshRecord), "meshes"},
    {SectionKind::kRegions, sizeof(RegionRecord), "regions"},
    {SectionKind::kNodes, sizeof(NodeRecord), "nodes"},
    {SectionKind::kGraphRows, sizeof(uint32_t), "graph rows"},
    {SectionKind::kGraphColumns, sizeof(uint32_t), "graph columns"},
    {SectionKind::kGraphValues, sizeof(float), "graph values"},
    {SectionKind::kRegionVertices, sizeof(uint32_t), "region vertices"},
    {SectionKind::kCarry, sizeof(float), "carry"},
    {SectionKind::kRegionModes, sizeof(RegionModesRecord), "region modes"},
    {SectionKind::kModes, sizeof(ModeRecord), "modes"},
    {SectionKind::kModeMatrices, sizeof(float), "mode matrices"},
    {SectionKind::kClips, sizeof(ClipRecord), "clips"},
    {SectionKind::kClipFrames, 12 * sizeof(float), "clip frames"},
    {SectionKind::kLevels, sizeof(LevelRecord), "levels"},
    {SectionKind::kPicks, sizeof(uint32_t), "picks"},
    {SectionKind::kSpread, sizeof(float), "spread"},
    {SectionKind::kTiers, sizeof(TierRecord), "tiers"},
    {SectionKind::kPrimitives, sizeof(PrimitiveRecord), "primitives"},
    {SectionKind::kTangents, 4 * sizeof(float), "tangents"},
    {SectionKind::kRods, sizeof(RodRecord), "rods"},
    {SectionKind::kRodSegments, sizeof(RodSegmentRecord), "rod segments"},
    {SectionKind::kJointRods, sizeof(uint32_t), "joint rods"},
    {SectionKind::kProxies, sizeof(ProxyRecord), "proxies"},
    {SectionKind::kRodNetwork, sizeof(NetworkRecord), "rod network"},
    {SectionKind::kRodDense, sizeof(DenseRecord), "rod dense layers"},
    {SectionKind::kRodWeights, sizeof(float), "rod weights"},
    {SectionKind::kPatchNetwork, sizeof(NetworkRecord), "patch network"},
    {SectionKind::kPatchDense, sizeof(DenseRecord), "patch dense layers"},
    {SectionKind::kPatchWeights, sizeof(float), "patch weights"},
    {SectionKind::kPatchMaterial, 3 * sizeof(float), "patch material"},
    {SectionKind::kPatchHeld, 1, "patch held"},
};

const SectionRule* find_rule(uint32_t kind) noexcept;  // null: not known

struct SectionTable {
  FileKind kind{};
  std::array<std::span<const std::byte>, std::size(kSectionRules)>
      sections;  // as kSectionRules; left out: empty

  // T is the element, or the plain number that elements are made of.
  template <class T>
  std::span<const T> get(SectionKind section) const noexcept {
    const size_t index = static_cast<size_t>(find_rule(static_cast<uint32_t>(section)) - kSectionRules);
    const std::span<const std::byte> bytes = sections[index];
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
};

Status read_section_table(std::span<const std::byte> bytes, SectionTable* out) noexcept;

}  // namespace sinew::pack
