// describe_asset.cpp  see describe_asset.hpp.
#include "world/describe_asset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

#include "character/life/create_instance.hpp"
#include "character/motion/pose.hpp"

namespace sinew::world {
namespace {

// ---- paths ----

// Which of its parent's children of its name a joint is, from 1.
uint32_t place_among_namesakes(const pack::PackView& pack, uint32_t joint) noexcept {
  const pack::JointRecord& record = pack.joints[joint];
  const char* name = pack::string_at(pack, record.name);
  uint32_t place = 1;
  for (uint32_t j = 0; j < joint; ++j) {
    const pack::JointRecord& other = pack.joints[j];
    place += other.parent == record.parent && std::strcmp(pack::string_at(pack, other.name), name) == 0;
  }
  return place;
}

// "#2", or nothing of a first one.
struct Ordinal {
  char text[16] = {};
  explicit Ordinal(uint32_t place) noexcept {
    if (place > 1) std::snprintf(text, sizeof text, "#%u", place);
  }
};

size_t step_length(const pack::PackView& pack, uint32_t joint, const Ordinal& ordinal) noexcept {
  return std::strlen(pack::string_at(pack, pack.joints[joint].name)) + std::strlen(ordinal.text);
}

// Writes text so that it ends before `end`, as far as that is within the room; returns where it begins.
size_t write_before(const char* text, size_t end, std::span<char> out) noexcept {
  const size_t length = std::strlen(text), begin = end - length;
  for (size_t i = 0; i < length && begin + i + 1 < out.size(); ++i) out[begin + i] = text[i];
  return begin;
}

// ---- clips ----

struct FramePlace {
  uint32_t frame;
  double share;  // of the way to the next one
};

FramePlace frame_at(const pack::ClipRecord& clip, double time_s, ClipEnd end) noexcept {
  const double last = clip.frame_count - 1, rate_hz = static_cast<double>(clip.rate_hz),
               end_s = last / rate_hz;
  if (end == ClipEnd::kLoop && last > 0) time_s = std::fmod(time_s, end_s);
  if (end == ClipEnd::kLoop && time_s < 0) time_s += end_s;
  const double place = std::clamp(std::clamp(time_s, 0.0, end_s) * rate_hz, 0.0, last);
  const auto frame = static_cast<uint32_t>(place);
  return {frame, place - frame};
}

// ---- rods ----

// A swing of w: damping_s resists its bending, drag its speed; both of its first segment.
float damping_ratio_of(const pack::PackView& pack, const pack::RodRecord& rod) noexcept {
  const pack::RodSegmentRecord& segment = pack.rod_segments[rod.first_segment];
  const float w = 2 * std::numbers::pi_v<float> * rod.frequency_hz;
  return w * segment.damping_s / 2 + segment.drag_per_s / (2 * w);
}

}  // namespace

AssetInfo describe(const Asset& asset) noexcept {
  const pack::CharacterRecord& character = *asset.pack.character;
  return {.vertex_count = character.vertex_count,
          .triangle_count = character.triangle_count,
          .joint_count = character.joint_count,
          .region_count = character.region_count,
          .node_count = character.node_count,
          .clip_count = character.clip_count,
          .mesh_count = character.mesh_count,
          .primitive_count = static_cast<uint32_t>(asset.pack.primitives.size()),
          .moved_vertex_count = asset.soft.count,
          .proxy_count = character.proxy_count,
          .rod_count = character.rod_count,
          .rod_network = asset.rod_network.record != nullptr,
          .graph_levels = asset.level_count,
          .tick_hz = asset.pack.network->rate_hz,
          .height_m = character.height_m,
          .unit_m = character.unit_m,
          .instance_bytes = instance_bytes(asset)};
}

AssetArrays arrays_of(const Asset& asset) noexcept {
  const pack::PackView& pack = asset.pack;
  return {.positions_m = pack.positions,
          .normals = pack.normals,
          .tangents = pack.tangents,
          .triangles = pack.triangles,
          .moved_vertices = asset.soft.all(),
          .skin_joints = pack.skin.data()->joint,
          .skin_weights = pack.skin.data()->weight,
          .skin_stride_bytes = sizeof(pack::SkinRecord)};
}

MeshInfo describe_mesh(const pack::PackView& pack, uint32_t mesh) noexcept {
  const pack::MeshRecord& record = pack.meshes[mesh];
  MeshInfo info{.name = pack::string_at(pack, record.name),
                .first_vertex = record.first_vertex,
                .vertex_count = record.vertex_count};
  const auto first = std::ranges::lower_bound(pack.primitives, mesh, {}, &pack::PrimitiveRecord::mesh);
  const auto end = std::ranges::upper_bound(pack.primitives, mesh, {}, &pack::PrimitiveRecord::mesh);
  info.first_primitive = static_cast<uint32_t>(first - pack.primitives.begin());
  info.primitive_count = static_cast<uint32_t>(end - first);
  std::copy_n(record.mesh_from_bind, 12, &info.mesh_from_bind.m[0][0]);
  return info;
}

PrimitiveInfo describe_primitive(const pack::PackView& pack, uint32_t primitive) noexcept {
  const pack::PrimitiveRecord& record = pack.primitives[primitive];
  return {.mesh = record.mesh,
          .index = record.index,
          .material = record.material == pack::kNoIndex ? nullptr : pack::string_at(pack, record.material),
          .first_vertex = record.first_vertex,
          .vertex_count = record.vertex_count,
          .first_triangle = record.first_triangle,
          .triangle_count = record.triangle_count};
}

JointInfo describe_joint(const Asset& asset, uint32_t joint) noexcept {
  const pack::PackView& pack = asset.pack;
  const pack::JointRecord& record = pack.joints[joint];
  JointInfo info{.name = pack::string_at(pack, record.name), .parent = record.parent};
  std::copy_n(record.inverse_bind, 12, &info.inverse_bind.m[0][0]);
  if (joint >= pack.joint_rods.size() || pack.joint_rods[joint] == pack::kNoIndex) return info;
  const uint32_t segment = pack.joint_rods[joint];
  for (uint32_t r = 0; r < pack.rods.size(); ++r)
    if (segment - pack.rods[r].first_segment < pack.rods[r].segment_count) info.rod = r;
  return info;
}

RegionInfo describe_region(const pack::PackView& pack, uint32_t region) noexcept {
  const pack::RegionRecord& record = pack.regions[region];
  const pack::RegionModesRecord& modes = pack.region_modes[region];
  RegionInfo info{.name = pack::string_at(pack, record.name),
                  .vertices = pack.region_vertices.subspan(record.first_vertex, record.vertex_count),
                  .node_count = record.node_count,
                  .radius_m = record.radius_m,
                  .displacement_limit_m = record.displacement_limit_m,
                  .frequency_hz = modes.first_rad_per_s / (2 * std::numbers::pi_v<float>),
                  .damping_ratio = modes.mode_count > 0 ? pack.modes[modes.first_mode].damping_ratio : 0};
  std::copy_n(record.center_m, 3, info.center_m);
  return info;
}

RodInfo describe_rod(const Asset& asset, uint32_t rod) noexcept {
  const pack::PackView& pack = asset.pack;
  const pack::RodRecord& record = pack.rods[rod];
  RodInfo info{.name = pack::string_at(pack, record.name),
               .attach_joint = record.attach,
               .segment_count = record.segment_count,
               .frequency_hz = record.frequency_hz,
               .gravity = record.gravity,
               .turn_limit_rad = record.turn_limit_rad};
  if (record.end_holder > 0) info.end_joint = record.end_holder - 1;
  if (record.frequency_hz > 0) info.damping_ratio = damping_ratio_of(pack, record);
  const RodSeat& seat = asset.rods.seats()[rod];
  for (const RodSlot& slot : asset.rods.slots().subspan(seat.first_slot + 1, seat.segment_count()))
    info.length_m += slot.length_m;
  return info;
}

ProxyInfo describe_proxy(const pack::PackView& pack, uint32_t proxy) noexcept {
  const pack::ProxyRecord& record = pack.proxies[proxy];
  ProxyInfo info{.joint = record.joint, .radius_m = record.radius_m};
  std::copy_n(record.from_m, 3, info.from_m);
  std::copy_n(record.to_m, 3, info.to_m);
  return info;
}

ClipInfo describe_clip(const pack::PackView& pack, uint32_t clip) noexcept {
  const pack::ClipRecord& record = pack.clips[clip];
  return {.name = pack::string_at(pack, record.name),
          .duration_s = static_cast<float>(record.frame_count - 1) / record.rate_hz,
          .frame_count = record.frame_count,
          .rate_hz = record.rate_hz};
}

size_t write_joint_path(const pack::PackView& pack, uint32_t joint, std::span<char> out) noexcept {
  size_t length = 0;
  for (uint32_t j = joint; j != pack::kNoIndex; j = pack.joints[j].parent)
    length += step_length(pack, j, Ordinal(place_among_namesakes(pack, j))) + (j != joint);
  size_t end = length;
  for (uint32_t j = joint; j != pack::kNoIndex; j = pack.joints[j].parent) {
    if (j != joint) end = write_before("/", end, out);
    end = write_before(Ordinal(place_among_namesakes(pack, j)).text, end, out);
    end = write_before(pack::string_at(pack, pack.joints[j].name), end, out);
  }
  if (!out.empty()) out[std::min(length, out.size() - 1)] = '\0';
  return length;
}

void sample_clip(const pack::PackView& pack, uint32_t clip, double time_s, ClipEnd end,
                 Matrix34* out) noexcept {
  const pack::ClipRecord& record = pack.clips[clip];
  const FramePlace at = frame_at(record, time_s, end);
  const size_t joints = pack.joints.size();
  const auto* frame = reinterpret_cast<const Matrix34*>(
      pack.clip_frames.data() + 12 * joints * (size_t{record.first_frame} + at.frame));
  if (!(at.share > 0)) {
    std::copy_n(frame, joints, out);
    return;
  }
  for (size_t j = 0; j < joints; ++j) {
    const JointParts a = split_joint(frame[j]), b = split_joint(frame[joints + j]);
    out[j] = joint_between(a, a, a, b, {.next = at.share});
  }
}

}  // namespace sinew::world
