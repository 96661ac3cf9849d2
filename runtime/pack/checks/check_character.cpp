// check_character.cpp  Joints, mesh, skin, clips and tiers agree with each other and with the character's
// counts.
#include <algorithm>
#include <cmath>

#include "core/status.hpp"
#include "pack/checks/checks.hpp"
#include "sinew/types.hpp"

namespace sinew::pack {
namespace {

constexpr uint32_t kMaxJoints = 65535;  // a skin's joints are 16 bits
constexpr float kLeastUnit_m = 1e-12f, kMostUnit_m = 1e12f;
constexpr float kSlowestClip_hz = 1e-4f;
constexpr float kMostCost_us = 1e9f, kMostError = 1e9f;

Status check_record(const PackView& pack) noexcept {
  if (pack.character == nullptr) return corrupt("it has no character record, or more than one");
  const CharacterRecord& record = *pack.character;
  if (record.vertex_count == 0) return corrupt("the character has no vertices");
  if (record.joint_count == 0 || record.joint_count > kMaxJoints)
    return corrupt("the character has %u joints, outside 1..65535", record.joint_count);
  if (!is_within(record.height_m, 0, kFarthest_m))
    return corrupt("the character's height is %g m, outside 0..1e5", double{record.height_m});
  if (!is_within(record.unit_m, kLeastUnit_m, kMostUnit_m))
    return corrupt("a unit of the character's file is %g m", double{record.unit_m});
  if (Status status = check_name(pack, record.name, "character", 0); !status.ok()) return status;
  return check_zero(record.reserved, "character", 0);
}

Status check_inputs_there(const PackView& pack) noexcept {
  if (!has_network(pack) || !pack.inputs.empty()) return {};
  return core::make_status(
      StatusCode::kUnsupported,
      "pack: its network has the paper's wiring, which characters do not run yet; bake with weights "
      "whose metadata names 'inputs'");
}

Status check_counts(const PackView& pack) noexcept {
  const CharacterRecord& record = *pack.character;
  struct Count {
    const char* section;
    uint64_t there, stated;
  };
  const uint64_t vertices = record.vertex_count;
  const Count counts[] = {{"joints", pack.joints.size(), record.joint_count},
                          {"positions", pack.positions.size(), 3 * vertices},
                          {"normals", pack.normals.size(), 3 * vertices},
                          {"triangles", pack.triangles.size(), 3 * uint64_t{record.triangle_count}},
                          {"skin", pack.skin.size(), vertices},
                          {"colors", pack.colors.size(), 4 * vertices},
                          {"welded", pack.welded.size(), vertices},
                          {"face normals", pack.face_normals.size(), 3 * vertices},
                          {"meshes", pack.meshes.size(), record.mesh_count},
                          {"regions", pack.regions.size(), record.region_count},
                          {"nodes", pack.nodes.size(), record.node_count},
                          {"graph rows", pack.graph_rows.size(), uint64_t{record.node_count} + 1},
                          {"graph values", pack.graph_values.size(), pack.graph_columns.size()},
                          {"region modes", pack.region_modes.size(), record.region_count},
                          {"clips", pack.clips.size(), record.clip_count}};
  for (const Count& count : counts)
    if (count.there != count.stated)
      return corrupt("%s: %llu numbers there, %llu wanted by the character's counts", count.section,
                     static_cast<unsigned long long>(count.there),
                     static_cast<unsigned long long>(count.stated));
  return {};
}

double determinant(const float (&m)[12]) noexcept {
  const auto minor = [&](size_t i, size_t j) {
    const size_t a = (j + 1) % 3, b = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
    return double{m[4 * r + a]} * double{m[4 * s + b]} - double{m[4 * r + b]} * double{m[4 * s + a]};
  };
  return double{m[0]} * minor(0, 0) + double{m[1]} * minor(0, 1) + double{m[2]} * minor(0, 2);
}

// The inverse, which is where the joint is in the bind pose, has to leave room for it to move in what a pose
// may be. What has none counts as the identity (character/motion/pose.hpp).
bool has_bind(const JointRecord& joint) noexcept {
  const float(&m)[12] = joint.inverse_bind;
  const double d = std::fabs(determinant(m));
  if (!(d > 1e-20)) return true;
  double inverse[3][3], most = 0;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      const size_t a = (i + 1) % 3, b = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
      inverse[i][j] =
          (double{m[4 * r + a]} * double{m[4 * s + b]} - double{m[4 * r + b]} * double{m[4 * s + a]}) / d;
    }
  for (const auto& row : inverse) {
    const double place = row[0] * double{m[3]} + row[1] * double{m[7]} + row[2] * double{m[11]};
    most = std::max({most, std::fabs(row[0]), std::fabs(row[1]), std::fabs(row[2]), std::fabs(place)});
  }
  return most <= double{kFarthest_m};
}

Status check_joints(const PackView& pack) noexcept {
  for (size_t index = 0; index < pack.joints.size(); ++index) {
    const JointRecord& joint = pack.joints[index];
    if (Status status = check_name(pack, joint.name, "joint", index); !status.ok()) return status;
    if (joint.parent != kNoIndex && joint.parent >= index)
      return corrupt("joint %zu: parent %u does not come before it", index, joint.parent);
    if (!are_within(joint.inverse_bind, kMostOfMatrix))
      return corrupt("joint %zu: inverse bind matrix has numbers that are not within +-1e6", index);
    if (!has_bind(joint)) return corrupt("joint %zu: its bind matrix goes beyond 1e5", index);
    if (Status status = check_zero(joint.reserved, "joint", index); !status.ok()) return status;
  }
  return {};
}

Status check_vertices(const PackView& pack) noexcept {
  if (Status status = check_within(pack.positions, kFarthest_m, "positions"); !status.ok()) return status;
  for (size_t vertex = 0; vertex < pack.character->vertex_count; ++vertex) {
    if (!is_unit(&pack.normals[3 * vertex]))
      return corrupt("vertex %zu: normal is not a unit vector", vertex);
    if (Status status = check_skin(pack.skin[vertex], pack.joints.size(), "vertex", vertex); !status.ok())
      return status;
    const uint32_t first = pack.welded[vertex];
    if (first > vertex || pack.welded[first] != first)
      return corrupt("vertex %zu: welded to %u, which is not the first vertex at its position", vertex,
                     first);
  }
  return {};
}

bool is_unit_or_zero(const float* v) noexcept { return is_unit(v) || (v[0] == 0 && v[1] == 0 && v[2] == 0); }

Status check_face_normals(const PackView& pack) noexcept {
  for (size_t vertex = 0; vertex < pack.character->vertex_count; ++vertex)
    if (!is_unit_or_zero(&pack.face_normals[3 * vertex]))
      return corrupt("vertex %zu: its triangles' normal is neither a unit vector nor zero", vertex);
  return {};
}

Status check_meshes(const PackView& pack) noexcept {
  uint64_t vertices = 0;
  for (size_t index = 0; index < pack.meshes.size(); ++index) {
    const MeshRecord& mesh = pack.meshes[index];
    if (Status status = check_name(pack, mesh.name, "mesh", index); !status.ok()) return status;
    if (mesh.first_vertex != vertices) return corrupt("mesh %zu: does not follow the mesh before it", index);
    if (first_not_finite(mesh.mesh_from_bind) != std::size(mesh.mesh_from_bind))
      return corrupt("mesh %zu: its matrix is not finite", index);
    if (mesh.reserved != 0) return corrupt("mesh %zu: a reserved field is not zero", index);
    vertices += mesh.vertex_count;
  }
  if (vertices != pack.character->vertex_count)
    return corrupt("meshes: have %llu vertices, the character %u", static_cast<unsigned long long>(vertices),
                   pack.character->vertex_count);
  return {};
}

Status check_triangles(const PackView& pack) noexcept {
  const uint32_t vertices = pack.character->vertex_count;
  const auto found =
      std::ranges::find_if(pack.triangles, [&](uint32_t vertex) { return vertex >= vertices; });
  if (found == pack.triangles.end()) return {};
  return corrupt("triangle %zu: vertex %u of %u", static_cast<size_t>(found - pack.triangles.begin()) / 3,
                 *found, vertices);
}

Status check_clips(const PackView& pack) noexcept {
  uint64_t frames = 0;
  for (size_t index = 0; index < pack.clips.size(); ++index) {
    const ClipRecord& clip = pack.clips[index];
    if (Status status = check_name(pack, clip.name, "clip", index); !status.ok()) return status;
    if (clip.first_frame != frames || clip.frame_count == 0)
      return corrupt("clip %zu: frames do not follow the clip before it, or are none", index);
    if (!is_within(clip.rate_hz, kSlowestClip_hz, kFastest_hz))
      return corrupt("clip %zu: rate %g Hz, outside 1e-4..1e4", index, double{clip.rate_hz});
    if (Status status = check_zero(clip.reserved, "clip", index); !status.ok()) return status;
    frames += clip.frame_count;
  }
  const uint64_t floats_a_frame = 12 * pack.joints.size();
  if (pack.clip_frames.size() % floats_a_frame != 0 || pack.clip_frames.size() / floats_a_frame != frames)
    return corrupt("clip frames: not as many as the clips state");
  return check_within(pack.clip_frames, kMostOfMatrix, "clip frames");
}

bool is_known_or_nan(float value, float most) noexcept {
  return std::isnan(value) || is_within(value, 0, most);
}

Status check_tier(const PackView& pack, const TierRecord& record, size_t index) noexcept {
  constexpr auto kFirstSimulated = static_cast<uint32_t>(Tier::kNetwork);
  if (!is_tier(record.tier)) return corrupt("tier %zu: %u is not known", index, record.tier);
  if (record.level >= pack.level_count || (record.level > 0 && record.tier < kFirstSimulated))
    return corrupt("tier %zu: LOD %u", index, record.level);
  if (!is_within(record.cost_us, 0, kMostCost_us) || !is_known_or_nan(record.cost_p99_us, kMostCost_us))
    return corrupt("tier %zu: cost %g us, p99 %g us", index, double{record.cost_us},
                   double{record.cost_p99_us});
  for (const float error :
       {record.error_mm, record.error_ratio, record.error_p95_mm, record.worst_error_ratio})
    if (!is_known_or_nan(error, kMostError))
      return corrupt("tier %zu: an error is negative or beyond 1e9", index);
  if (record.worst_clip != kNoIndex && record.worst_clip >= pack.clips.size())
    return corrupt("tier %zu: clip %u of %zu", index, record.worst_clip, pack.clips.size());
  return {};
}

uint64_t tier_order(const TierRecord& record) noexcept { return uint64_t{record.tier} << 32 | record.level; }

// With level 0.
uint32_t needed_tiers(const PackView& pack) noexcept {
  const auto bit = [](Tier tier) { return 1u << static_cast<uint32_t>(tier); };
  return bit(Tier::kSkinning) | bit(Tier::kExtrapolate) | bit(Tier::kModal) |
         (affords_network(pack) ? bit(Tier::kNetwork) : 0);
}

Status check_tiers(const PackView& pack) noexcept {
  uint32_t seen = 0;
  for (size_t index = 0; index < pack.tiers.size(); ++index) {
    const TierRecord& record = pack.tiers[index];
    if (Status status = check_tier(pack, record, index); !status.ok()) return status;
    if (index > 0 && tier_order(record) <= tier_order(pack.tiers[index - 1]))
      return corrupt("tier %zu: %u at LOD %u does not ascend", index, record.tier, record.level);
    if (record.tier == static_cast<uint32_t>(Tier::kNetwork) && !affords_network(pack))
      return corrupt("tier %zu: a network that the character does not have", index);
    if (record.level == 0) seen |= 1u << record.tier;
  }
  const uint32_t needed = needed_tiers(pack);
  return (seen & needed) == needed ? Status{} : corrupt("tiers: not all that the character has");
}

}  // namespace

Status check_character(const PackView& pack) noexcept {
  constexpr Check kChecks[] = {check_inputs_there, check_record,       check_counts,    check_joints,
                               check_vertices,     check_face_normals, check_triangles, check_meshes,
                               check_clips,        check_tiers};
  return run_checks(kChecks, pack);
}

}  // namespace sinew::pack
