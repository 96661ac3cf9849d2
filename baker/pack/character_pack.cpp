// character_pack.cpp  A character, its tissue and its network to one .sinew file.
#include "baker/pack/character_pack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/node_record.hpp"
#include "baker/pack/graph.hpp"
#include "baker/pack/modes_pack.hpp"
#include "baker/pack/network_pack.hpp"
#include "baker/pack/rods_pack.hpp"
#include "baker/pack/tier_pack.hpp"

namespace sinew::baker {
namespace {

using pack::SectionKind;

constexpr double kMaxClipSeconds = 600;
constexpr float kDisplacementLimit = 0.75f;    // share of a region's radius, where the weights do not say
constexpr float kRate_hz = 60, kSubsteps = 4;  // likewise

template <class Size>
uint32_t to_u32(Size value) {
  return static_cast<uint32_t>(value);
}

void append(const Vector3& v, std::vector<float>* out) {
  for (int axis = 0; axis < 3; ++axis) out->push_back(static_cast<float>(v[axis]));
}

// Row-major 3x4.
void append_affine(const Matrix4& m, std::vector<float>* out) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) out->push_back(static_cast<float>(m(row, column)));
}

// ---- the character ----

double height_of(const Character& character) {
  const auto [low, high] =
      std::ranges::minmax_element(character.positions, {}, [](const Vector3& p) { return p.y(); });
  return high->y() - low->y();
}

void add_record(const Character& character, const TissueLayout& layout, PackWriter& pack) {
  pack::CharacterRecord record{};
  record.name = pack.string(character.name);
  record.vertex_count = to_u32(character.positions.size());
  record.triangle_count = to_u32(character.triangles.size());
  record.joint_count = to_u32(character.joint_node.size());
  record.region_count = to_u32(layout.regions.size());
  record.node_count = to_u32(layout.nodes.size());
  record.clip_count = to_u32(character.clips.size());
  record.height_m = static_cast<float>(height_of(character));
  record.rod_count = to_u32(layout.rods.size());
  record.proxy_count = to_u32(layout.proxies.size());
  pack.section(SectionKind::kCharacter, std::vector{record});
}

void add_joints(const Character& character, PackWriter& pack) {
  std::vector<pack::JointRecord> joints;
  for (size_t j = 0; j < character.joint_node.size(); ++j) {
    pack::JointRecord joint{};
    joint.name = pack.string(character.nodes[static_cast<size_t>(character.joint_node[j])].name);
    joint.parent = character.joint_parent[j] < 0 ? pack::kNoIndex : to_u32(character.joint_parent[j]);
    std::vector<float> inverse_bind;
    append_affine(character.inverse_bind[j], &inverse_bind);
    std::ranges::copy(inverse_bind, joint.inverse_bind);
    joints.push_back(joint);
  }
  pack.section(SectionKind::kJoints, joints);
}

void add_mesh(const Character& character, PackWriter& pack) {
  std::vector<float> positions, normals;
  std::vector<pack::SkinRecord> skin;
  std::vector<uint8_t> colors;
  for (size_t v = 0; v < character.positions.size(); ++v) {
    append(character.positions[v], &positions);
    append(unit_or_up(character.normals[v]), &normals);
    skin.push_back(skin_record(character.skin[v]));
    colors.insert(colors.end(), character.colors[v].begin(), character.colors[v].end());
  }
  std::vector<uint32_t> triangles;
  for (const std::array<int, 3>& triangle : character.triangles)
    for (int vertex : triangle) triangles.push_back(to_u32(vertex));
  pack.section(SectionKind::kPositions, positions, 3);
  pack.section(SectionKind::kNormals, normals, 3);
  pack.section(SectionKind::kTriangles, triangles, 3);
  pack.section(SectionKind::kSkin, skin);
  pack.section(SectionKind::kColors, colors, 4);
  pack.section(SectionKind::kWelded, std::vector<uint32_t>(character.welded.begin(), character.welded.end()));
}

void check_duration(const Clip& clip) {
  if (!(clip.duration_s <= kMaxClipSeconds))
    throw BadInput("clip '" + clip.name + "' lasts " + std::to_string(clip.duration_s) +
                   " s; at most 600 s are packed: cut it, or leave it to the engine");
}

void add_clips(const Character& character, PackWriter& pack) {
  constexpr double kSlack = 1e-6;  // of a frame: a duration rounded to float must not add a frame
  std::vector<pack::ClipRecord> clips;
  std::vector<float> frames;
  uint32_t first_frame = 0;
  for (const Clip& clip : character.clips) {
    check_duration(clip);
    const auto intervals = to_u32(std::max(0.0, std::ceil(clip.duration_s * kClipRateHz - kSlack)));
    for (uint32_t frame = 0; frame <= intervals; ++frame) {
      const double t_s = std::min(frame / kClipRateHz, clip.duration_s);
      for (const Matrix4& joint : joint_matrices(character, &clip, t_s)) append_affine(joint, &frames);
    }
    clips.push_back(
        {pack.string(clip.name), first_frame, intervals + 1, static_cast<float>(kClipRateHz), {}});
    first_frame += intervals + 1;
  }
  pack.section(SectionKind::kClips, clips);
  pack.section(SectionKind::kClipFrames, frames, 12);
}

// ---- the tissue ----

void append_carry(const Region& region, uint32_t padded_vertices, std::vector<float>* carry) {
  for (const std::vector<double>& row : region.carry) {
    for (double weight : row) carry->push_back(static_cast<float>(weight));
    carry->resize(carry->size() + padded_vertices - row.size(), 0.0f);
  }
}

pack::RegionRecord to_record(const Region& region, const ModalBasis& basis, float displacement_limit) {
  pack::RegionRecord record{};
  record.anchor_node = to_u32(basis.anchor_node);
  record.first_node = to_u32(region.first_node);
  record.node_count = to_u32(region.node_count);
  record.vertex_count = to_u32(region.vertices.size());
  record.padded_vertices = (record.vertex_count + 15) / 16 * 16;
  for (int axis = 0; axis < 3; ++axis) record.center_m[axis] = static_cast<float>(region.center[axis]);
  record.radius_m = static_cast<float>(region.radius_m);
  record.displacement_limit_m = displacement_limit * record.radius_m;
  return record;
}

void add_regions(const TissueLayout& layout, const std::vector<ModalBasis>& modes, float displacement_limit,
                 PackWriter& pack) {
  std::vector<pack::RegionRecord> regions;
  std::vector<uint32_t> vertices;
  std::vector<float> carry;
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    const Region& region = layout.regions[r];
    pack::RegionRecord record = to_record(region, modes[r], displacement_limit);
    record.name = pack.string(region.name);
    record.first_vertex = to_u32(vertices.size());
    record.carry = carry.size();
    vertices.insert(vertices.end(), region.vertices.begin(), region.vertices.end());
    append_carry(region, record.padded_vertices, &carry);
    regions.push_back(record);
  }
  pack.section(SectionKind::kRegions, regions);
  pack.section(SectionKind::kRegionVertices, vertices);
  pack.section(SectionKind::kCarry, carry);
}

void add_nodes(const TissueLayout& layout, PackWriter& pack) {
  std::vector<pack::NodeRecord> nodes;
  for (const ControlNode& node : layout.nodes) nodes.push_back(node_record(node));
  pack.section(SectionKind::kNodes, nodes);
}

void add_graph(const GraphRows& graph, PackWriter& pack) {
  pack.section(SectionKind::kGraphRows, graph.rows);
  pack.section(SectionKind::kGraphColumns, graph.columns);
  pack.section(SectionKind::kGraphValues, graph.values);
}

// ---- weights ----

void check_wiring(const Safetensors& weights) {
  check_model(weights);
  if (!weights.metadata.contains("inputs"))
    throw BadInput(weights.path +
                   ": metadata key 'inputs' is missing (the paper's wiring), which characters cannot run in "
                   "this version; use weights from baker/train");
  if (weights.metadata.contains("without"))
    throw BadInput(
        weights.path +
        ": metadata key 'without': trained with inputs left out, for comparison only; train without it");
  for (const auto& [key, wanted] : {std::pair{"frame", "bent"}, std::pair{"base", "modal"}}) {
    const auto found = weights.metadata.find(key);
    if (found == weights.metadata.end() || found->second != wanted)
      throw BadInput(weights.path + ": metadata key '" + key + "' is not '" + wanted +
                     "': these weights were trained for another version's tissue; train again");
  }
}

void check_joint_count(const Character& character) {
  if (character.joint_node.size() > std::numeric_limits<uint16_t>::max())
    throw BadInput(character.name + ": " + std::to_string(character.joint_node.size()) +
                   " joints, of which a pack holds 65535; remove joints without skin weight");
}

// A number of the weights' metadata; `fallback` also where there are no weights.
float number_of(const Safetensors* weights, const std::string& key, float fallback, float low, float high) {
  return weights == nullptr ? fallback : metadata_number(*weights, key, fallback, low, high);
}

void add_tiers(const Safetensors* weights, const TierWork& work, PackWriter& pack) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN(), kLargest = 1e6f;
  const float error_mm = number_of(weights, "error_mm", kUnknown, 0, kLargest);
  const float error_ratio = number_of(weights, "error_ratio", kUnknown, 0, kLargest);
  pack.section(SectionKind::kTiers, make_tiers(work, error_mm, error_ratio));
}

size_t rod_segments(const TissueLayout& layout) {
  size_t count = 0;
  for (const Rod& rod : layout.rods) count += rod.bones.size();
  return count;
}

// rate_hz alone.
std::vector<pack::LayerRecord> add_no_network(PackWriter& pack) {
  pack::NetworkRecord record{};
  record.model = pack::ModelKind::kNone;
  record.rate_hz = kRate_hz;
  pack.section(SectionKind::kNetwork, std::vector{record});
  return {};
}

}  // namespace

std::vector<std::byte> pack_character(const Character& character, const TissueLayout& layout,
                                      const std::vector<ModalBasis>& modes, const Safetensors* weights,
                                      pack::Precision precision, std::span<const HeardRanges> ranges) {
  if (weights != nullptr) check_wiring(*weights);
  check_joint_count(character);
  PackWriter pack(pack::FileKind::kCharacter);
  const std::vector<pack::LayerRecord> layers =
      weights != nullptr ? add_network(*weights, pack, precision, ranges) : add_no_network(pack);
  add_record(character, layout, pack);
  add_joints(character, pack);
  add_mesh(character, pack);
  add_clips(character, pack);
  check_modes(layout, modes);
  add_regions(layout, modes, number_of(weights, "displacement_limit", kDisplacementLimit, 1e-3f, 100), pack);
  add_nodes(layout, pack);
  const GraphRows graph =
      normalized_adjacency(layout.nodes.size(), layout.edges, character.name + ": control graph");
  add_graph(graph, pack);
  add_rods(character, layout.rods, pack);
  add_proxies(layout.proxies, pack);
  const uint64_t mode_floats =
      add_modes(layout, modes,
                {.rate_hz = number_of(weights, "rate_hz", kRate_hz, 1, 1000),
                 .substeps = static_cast<int>(number_of(weights, "base_substeps", kSubsteps, 1, 64))},
                pack);
  add_tiers(weights,
            {.nodes = layout.nodes.size(),
             .mode_floats = mode_floats,
             .network_multiply_adds = multiply_adds(layers, layout.nodes.size(), graph.columns.size()),
             .rod_segments = rod_segments(layout)},
            pack);
  return pack.finish();
}

}  // namespace sinew::baker
