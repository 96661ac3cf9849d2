// character_pack.cpp  A character, its tissue and its network to one .sinew file.
#include "baker/pack/character/character_pack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/common/bad_input.hpp"
#include "baker/import/character/smooth_groups.hpp"
#include "baker/mesh/graph/node_record.hpp"
#include "baker/pack/character/modes_pack.hpp"
#include "baker/pack/character/patches_pack.hpp"
#include "baker/pack/character/primitives_pack.hpp"
#include "baker/pack/character/rods_pack.hpp"
#include "baker/pack/character/tier_pack.hpp"
#include "baker/pack/network/dense_pack.hpp"
#include "baker/pack/network/graph.hpp"
#include "baker/pack/network/network_pack.hpp"

namespace sinew::baker {
namespace {

using pack::SectionKind;

constexpr double kMaxClipSeconds = 600;
constexpr float kRate_hz = 60;  // where the weights do not say

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

void add_record(const Character& character, const TissueLayout& layout, size_t coarser, PackWriter& pack) {
  pack::CharacterRecord record{};
  record.name = pack.string(character.name);
  record.vertex_count = to_u32(character.positions.size());
  record.triangle_count = to_u32(character.triangles.size());
  record.joint_count = to_u32(character.joint_node.size());
  record.region_count = to_u32(layout.regions.size());
  record.node_count = to_u32(layout.nodes.size());
  record.clip_count = to_u32(character.clips.size());
  record.height_m = static_cast<float>(height_m(character));
  record.rod_count = to_u32(layout.rods.size());
  record.proxy_count = to_u32(layout.proxies.size());
  record.coarser_count = to_u32(coarser);
  record.unit_m = static_cast<float>(character.unit_m);
  record.mesh_count = character.meshes.empty() ? 1 : to_u32(character.meshes.size());
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
  const std::vector<int> groups = smooth_groups(character);
  pack.section(SectionKind::kWelded, std::vector<uint32_t>(groups.begin(), groups.end()));
  std::vector<float> faces;
  for (const Vector3& area : area_vectors(character, groups))
    append(area.norm() > 0 ? area.normalized() : Vector3::Zero(), &faces);
  pack.section(SectionKind::kFaceNormals, faces, 3);
}

// Of a character that was made and not imported all vertices are one mesh.
std::vector<MeshSpan> meshes_of(const Character& character) {
  if (!character.meshes.empty()) return character.meshes;
  return {{.vertex_count = character.positions.size()}};
}

void add_meshes(const Character& character, PackWriter& pack) {
  std::vector<pack::MeshRecord> meshes;
  for (const MeshSpan& span : meshes_of(character)) {
    pack::MeshRecord mesh{};
    const auto node = static_cast<size_t>(span.node);
    mesh.name = pack.string(node < character.nodes.size() ? character.nodes[node].name : character.name);
    mesh.first_vertex = to_u32(span.first_vertex);
    mesh.vertex_count = to_u32(span.vertex_count);
    std::vector<float> affine;
    append_affine(span.mesh_from_bind, &affine);
    std::ranges::copy(affine, mesh.mesh_from_bind);
    meshes.push_back(mesh);
  }
  pack.section(SectionKind::kMeshes, meshes);
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

pack::RegionRecord to_record(const Region& region, const ModalBasis& basis, bool emulates) {
  pack::RegionRecord record{};
  record.anchor_node = to_u32(basis.anchor_node);
  record.first_node = to_u32(region.first_node);
  record.node_count = to_u32(region.node_count);
  record.vertex_count = to_u32(region.vertices.size());
  record.padded_vertices = (record.vertex_count + 15) / 16 * 16;
  for (int axis = 0; axis < 3; ++axis) record.center_m[axis] = static_cast<float>(region.center[axis]);
  record.radius_m = static_cast<float>(region.radius_m);
  record.displacement_limit_m = static_cast<float>(region.max_displacement * region.radius_m);
  record.touches_body = region.touches_body;
  record.cell_m = emulates ? static_cast<float>(region.cell_m) : 0;
  return record;
}

// Returns the floats of the carrying weights.
uint64_t add_regions(const TissueLayout& layout, const std::vector<ModalBasis>& modes, bool first,
                     bool emulates, PackWriter& pack) {
  std::vector<pack::RegionRecord> regions;
  std::vector<uint32_t> vertices;
  std::vector<float> carry;
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    const Region& region = layout.regions[r];
    pack::RegionRecord record = to_record(region, modes[r], emulates);
    record.name = pack.string(region.name);
    record.first_vertex = to_u32(vertices.size());
    record.carry = carry.size();
    vertices.insert(vertices.end(), region.vertices.begin(), region.vertices.end());
    append_carry(region, record.padded_vertices, &carry);
    regions.push_back(record);
  }
  pack.append(SectionKind::kRegions, regions);
  pack.append(SectionKind::kCarry, carry);
  if (first) pack.section(SectionKind::kRegionVertices, vertices);
  return carry.size();
}

void add_nodes(const TissueLayout& layout, PackWriter& pack) {
  std::vector<pack::NodeRecord> nodes;
  for (const ControlNode& node : layout.nodes) nodes.push_back(node_record(node));
  pack.append(SectionKind::kNodes, nodes);
}

void add_graph(const GraphRows& graph, PackWriter& pack) {
  pack.append(SectionKind::kGraphRows, graph.rows);
  pack.append(SectionKind::kGraphColumns, graph.columns);
  pack.append(SectionKind::kGraphValues, graph.values);
}

// ---- its levels ----

struct TissueOptions {
  double rate_hz;
  std::string where;  // of complaints
  bool emulates = false;
};

pack::LevelRecord add_tissue(const TissueLayout& layout, const std::vector<ModalBasis>& modes,
                             const TissueOptions& options, bool first, PackWriter& pack) {
  check_modes(layout, modes);
  pack::LevelRecord record{};
  record.node_count = to_u32(layout.nodes.size());
  record.carry_floats = add_regions(layout, modes, first, options.emulates, pack);
  add_nodes(layout, pack);
  const GraphRows graph = normalized_adjacency(layout.nodes.size(), layout.edges, options.where);
  record.graph_entries = to_u32(graph.columns.size());
  add_graph(graph, pack);
  record.matrix_floats = add_modes(layout, modes, options.rate_hz, first, pack);
  return record;
}

void check_fits(const TissueLayout& finer, const TissueLayout& coarser) {
  bool fits = finer.regions.size() == coarser.regions.size();
  for (size_t r = 0; fits && r < finer.regions.size(); ++r)
    fits = finer.regions[r].vertices == coarser.regions[r].vertices;
  if (!fits) throw BadInput("a coarser control graph has other regions than the finer one");
}

size_t node_on(const TissueLayout& layout, const ControlNode& node) {
  const Region& region = layout.regions[static_cast<size_t>(node.region)];
  for (int n = region.first_node; n < region.first_node + region.node_count; ++n)
    if (layout.nodes[static_cast<size_t>(n)].vertex == node.vertex) return static_cast<size_t>(n);
  throw BadInput("region '" + region.name + "': a coarser control graph has a node on vertex " +
                 std::to_string(node.vertex) + ", where the finer one has none");
}

void add_picks(const TissueLayout& finer, const TissueLayout& coarser, PackWriter& pack) {
  std::vector<uint32_t> picks;
  for (const ControlNode& node : coarser.nodes) picks.push_back(to_u32(node_on(finer, node)));
  pack.append(SectionKind::kPicks, picks);
}

// A coarser node's weights on a finer region's nodes: those on the vertices that they stand on.
void append_spread(const TissueLayout& finer, const Region& region, const std::vector<double>& carry,
                   std::vector<float>* spread) {
  for (int n = region.first_node; n < region.first_node + region.node_count; ++n) {
    const int vertex = finer.nodes[static_cast<size_t>(n)].vertex;
    const auto at = std::ranges::lower_bound(region.vertices, vertex) - region.vertices.begin();
    if (static_cast<size_t>(at) >= carry.size() || region.vertices[static_cast<size_t>(at)] != vertex)
      throw BadInput("levels: a control node lies outside the vertices of its region");
    spread->push_back(static_cast<float>(carry[static_cast<size_t>(at)]));
  }
  spread->resize((spread->size() + 15) / 16 * 16, 0.0f);
}

// Returns its floats.
uint64_t add_spread(const TissueLayout& finer, const TissueLayout& coarser, PackWriter& pack) {
  std::vector<float> spread;
  for (size_t r = 0; r < coarser.regions.size(); ++r)
    for (const std::vector<double>& carry : coarser.regions[r].carry)
      append_spread(finer, finer.regions[r], carry, &spread);
  pack.append(SectionKind::kSpread, spread);
  return spread.size();
}

std::vector<pack::LevelRecord> add_levels(const TissueLayout& layout, const std::vector<ModalBasis>& modes,
                                          std::span<const GraphLevel> coarser, const TissueOptions& options,
                                          PackWriter& pack) {
  std::vector<pack::LevelRecord> records = {add_tissue(layout, modes, options, true, pack)};
  const TissueLayout* finer = &layout;
  for (const GraphLevel& level : coarser) {
    check_fits(*finer, level.layout);
    records.push_back(add_tissue(level.layout, level.modes, options, false, pack));
    add_picks(*finer, level.layout, pack);
    records.back().spread_floats = add_spread(*finer, level.layout, pack);
    finer = &level.layout;
  }
  if (!coarser.empty()) pack.section(SectionKind::kLevels, records);
  return records;
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
  for (const auto& [key, wanted] : {std::pair{"frame", "bent"}, std::pair{"base", "modal_2"}}) {
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

void add_tiers(const std::vector<pack::LevelRecord>& levels, const std::vector<pack::LayerRecord>& layers,
               uint64_t patch_multiply_adds, const RodWork& rods, PackWriter& pack) {
  std::vector<TierWork> work;
  for (const pack::LevelRecord& level : levels)
    work.push_back({.nodes = level.node_count,
                    .mode_floats = level.matrix_floats,
                    .network_multiply_adds =
                        patch_multiply_adds + multiply_adds(layers, level.node_count, level.graph_entries),
                    .rods = rods});
  pack.section(SectionKind::kTiers, make_tiers(work));
}

RodWork rod_work(const TissueLayout& layout, uint64_t network_multiply_adds) {
  RodWork work;
  for (const Rod& rod : layout.rods) {
    work.segments += rod.bones.size();
    if (rod.learned_start) work.network_multiply_adds += rod.bones.size() * network_multiply_adds;
  }
  return work;
}

// rate_hz alone.
std::vector<pack::LayerRecord> add_no_network(float rate_hz, PackWriter& pack) {
  pack::NetworkRecord record{};
  record.model = pack::ModelKind::kNone;
  record.rate_hz = rate_hz;
  pack.section(SectionKind::kNetwork, std::vector{record});
  return {};
}

}  // namespace

std::vector<std::byte> pack_character(const Character& character, const TissueLayout& layout,
                                      const std::vector<ModalBasis>& modes, const Safetensors* weights,
                                      std::span<const GraphLevel> coarser, const Safetensors* rod_weights,
                                      const Safetensors* emulator) {
  if (weights != nullptr) check_wiring(*weights);
  check_joint_count(character);
  const float rate_hz = number_of(weights != nullptr ? weights : emulator, "rate_hz", kRate_hz, 1, 1000);
  PackWriter pack(pack::FileKind::kCharacter);
  const std::vector<pack::LayerRecord> layers =
      weights != nullptr ? add_network(*weights, pack) : add_no_network(rate_hz, pack);
  add_record(character, layout, coarser.size(), pack);
  add_joints(character, pack);
  add_mesh(character, pack);
  add_meshes(character, pack);
  add_primitives(character, pack);
  add_tangents(character, pack);
  add_clips(character, pack);
  const bool emulates = emulator != nullptr && std::ranges::any_of(layout.regions, [](const Region& region) {
                          return region.cell_m > 0;
                        });
  const TissueOptions options{.rate_hz = static_cast<double>(rate_hz),
                              .where = character.name + ": control graph",
                              .emulates = emulates};
  const std::vector<pack::LevelRecord> levels = add_levels(layout, modes, coarser, options, pack);
  const bool has_rod_network = rod_weights != nullptr && !layout.rods.empty();
  add_rods(character, layout.rods, has_rod_network, pack);
  const uint64_t network_ops = has_rod_network ? add_rod_network(*rod_weights, pack) : 0;
  add_proxies(layout.proxies, pack);
  const uint64_t patch_ops =
      emulates ? add_patches(layout, *emulator, static_cast<double>(rate_hz), pack) : 0;
  add_tiers(levels, layers, patch_ops, rod_work(layout, network_ops), pack);
  return pack.finish();
}

}  // namespace sinew::baker
